#include "bake/bake_stages.hpp"

#include "bake/voxels/available_memory.hpp"
#include "frontalis/error.hpp"

namespace frontalis
{

void BakeStages::advance(double done)
{
  if (progress_ && !progress_(name_, done))
    throw Error("interrupted");
}

void BakeStages::finish()
{
  if (name_.empty())
    return;
  advance(1);
  if (report_ != nullptr)
    report_->stages.push_back(
        { name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(), peak_memory() });
  name_.clear();
}

}  // namespace frontalis
