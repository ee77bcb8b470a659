#include "bake/available_memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace frontalis
{
namespace
{

constexpr double unknown = std::numeric_limits<double>::infinity();

/// The number that follows a word in a file; for an empty word, the first number. Infinite if there is none.
double number_in(const std::string& path, const std::string& after)
{
  std::ifstream file(path);
  std::string word;
  double value = 0;
  while (!after.empty() && file >> word && word != after)
  {
  }
  return file >> value ? value : unknown;
}

}  // namespace

double available_memory()
{
  const double system = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  double group = unknown;
  for (const std::string folder : { "/sys/fs/cgroup/", "/sys/fs/cgroup/memory/" })
  {
    const double limit =
        std::min(number_in(folder + "memory.max", ""), number_in(folder + "memory.limit_in_bytes", ""));
    const double used =
        std::min(number_in(folder + "memory.current", ""), number_in(folder + "memory.usage_in_bytes", ""));
    if (limit < unknown && used < unknown)
      group = std::min(group, std::max(0.0, limit - used));
  }
  return std::min(system, group);
}

double peak_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace frontalis
