#pragma once

#include "frontalis/bake/bake.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>

namespace frontalis
{

/// Measures the stages of a bake, collects its findings and asks the caller whether to continue. Used only by the
/// thread that called bake().
class BakeMonitor
{
public:
  BakeMonitor(BakeReport* report, const BakeProgress& progress) : report_(report), progress_(progress) {}

  /// Ends the current stage, if any, and begins `stage`.
  void begin(const std::string& stage);
  /// Reports the proportion of the stage that is done. Throws Error("interrupted") if the caller stops the bake.
  void advance(double done);
  void finish();
  void found(const std::string& sentence);
  /// Reports what is probably a mistake; a warning is shown without being asked for.
  template <class... Values>
  void warn(fmt::format_string<Values...> sentence, Values&&... values)
  {
    if (report_ != nullptr)
      report_->warnings.push_back(fmt::format(sentence, std::forward<Values>(values)...));
  }
  template <class First, class... Rest>
  void found(fmt::format_string<First, Rest...> sentence, First&& first, Rest&&... rest)
  {
    found(fmt::format(sentence, std::forward<First>(first), std::forward<Rest>(rest)...));
  }

private:
  BakeReport* report_;  ///< null if the caller wants no report
  const BakeProgress& progress_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

/// Calls body(0) .. body(count - 1) on all cores, about `grain` calls per task. Each call may write only data of its
/// own index. Meanwhile the calling thread reports progress; if the caller interrupts the bake, no further task begins.
/// If calls throw, the exception of the lowest index is rethrown.
void parallel_for(BakeMonitor& monitor, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body);

}  // namespace frontalis
