#include "solver/stepping/muscle_response.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

void MuscleResponse::advance(const std::vector<float>& asked_from, const std::vector<float>& asked_to, double seconds,
                             std::vector<float>& activation) const
{
  for (std::size_t m = 0; m < activation.size(); ++m)
  {
    const Muscle& muscle = model_.muscles[m];
    const double now = double(activation[m]), from = double(asked_from[m]), to = double(asked_to[m]);
    const double time = to > now ? muscle.rise_time : muscle.fall_time;
    double reached = to;
    if (time > 0)
    {
      const double lag = (to - from) * time / seconds;
      reached += -lag + (now - from + lag) * std::exp(-seconds / time);
    }
    if (model_.activation_slew > 0)
    {
      const double most = model_.activation_slew * seconds;
      reached = std::min(std::max(reached, now - most), now + most);
    }
    activation[m] = static_cast<float>(std::min(std::max(reached, 0.0), 1.0));
  }
}

}  // namespace frontalis
