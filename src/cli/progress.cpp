#include "cli/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <unistd.h>

namespace frontalis
{
namespace
{

constexpr unsigned long steps = 1000;
constexpr std::size_t name_width = 16;

}  // namespace

Progress::Progress(std::FILE* lines) : terminal_(isatty(STDERR_FILENO) != 0), lines_(lines) {}

void Progress::update(const std::string& stage, double done)
{
  if (stage != stage_)
  {
    stage_ = stage;
    clear();
    if (terminal_)
    {
      // The scale is printed in one line after the name, the bar in the next line.
      const std::string space(name_width, ' ');
      const std::string name = stage + std::string(name_width - std::min(name_width, stage.size()), ' ');
      bar_.emplace(steps, std::cerr, space, name, space);
    }
    else if (lines_ != nullptr)
      std::fprintf(lines_, "%s ...\n", stage.c_str());
    std::fflush(stdout);
  }
  if (!bar_)
    return;
  const auto reached = static_cast<unsigned long>(steps * (std::isfinite(done) ? std::clamp(done, 0.0, 1.0) : 0));
  if (reached > bar_->count())
    *bar_ += reached - bar_->count();
}

void Progress::clear()
{
  if (bar_ && bar_->count() < bar_->expected_count())
    std::cerr << std::endl;
  bar_.reset();
}

}  // namespace frontalis
