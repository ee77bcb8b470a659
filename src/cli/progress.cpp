#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace frontalis
{

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::update(const std::string& stage, double done, const std::string& remark)
{
  if (!terminal_)
  {
    if (stage != stage_)
      std::printf("%s ...\n", stage.c_str());
    std::fflush(stdout);
    stage_ = stage;
    return;
  }
  constexpr int width = 30;
  const double share = std::isfinite(done) ? std::clamp(done, 0.0, 1.0) : 0;
  const int full = static_cast<int>(share * width);
  const std::string line = stage + " [" + std::string(static_cast<std::size_t>(full), '#') +
                           std::string(static_cast<std::size_t>(width - full), ' ') + "] " +
                           std::to_string(static_cast<int>(share * 100)) + " % " + remark;
  if (line == shown_)
    return;
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  shown_ = line;
}

void Progress::clear()
{
  if (!shown_.empty())
    std::fprintf(stderr, "\r\033[K");
  shown_.clear();
}

}  // namespace frontalis
