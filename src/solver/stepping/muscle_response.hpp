#pragma once

#include "frontalis/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace frontalis
{

/// First-order response of muscles to commanded activations, which change linearly over `seconds`: da/dt = (asked - a)
/// / time with the rise or fall time (Zajac 1989, Crit. Rev. Biomed. Eng. 17:359). The model's slew rate limits da/dt.
inline void respond(const Model& model, const std::vector<float>& asked_from, const std::vector<float>& asked_to,
                    double seconds, std::vector<float>& activation)
{
  for (std::size_t m = 0; m < activation.size(); ++m)
  {
    const Muscle& muscle = model.muscles[m];
    const double now = double(activation[m]), from = double(asked_from[m]), to = double(asked_to[m]);
    const double time = to > now ? muscle.rise_time : muscle.fall_time;
    double reached = to;
    if (time > 0)
    {
      const double lag = (to - from) * time / seconds;
      reached += -lag + (now - from + lag) * std::exp(-seconds / time);
    }
    if (model.activation_slew > 0)
    {
      const double most = model.activation_slew * seconds;
      reached = std::min(std::max(reached, now - most), now + most);
    }
    activation[m] = static_cast<float>(std::min(std::max(reached, 0.0), 1.0));
  }
}

}  // namespace frontalis
