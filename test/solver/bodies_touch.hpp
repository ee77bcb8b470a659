#pragma once

#include "backends.hpp"
#include "contact_model.hpp"
#include "nodal_vectors.hpp"

#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace test
{

constexpr double degree = 3.14159265358979 / 180;

class BodiesTouch : public EveryBackend
{
protected:
  std::unique_ptr<Solver> make(const Model& model, int threads = 2, bool ledger = false, double time_step = 0) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), threads, time_step, ledger });
  }
};

inline double mean(const Vectors& vectors, std::size_t axis)
{
  double sum = 0;
  for (const auto& v : vectors)
    sum += v[axis];
  return sum / static_cast<double>(vectors.size());
}

inline double mechanical(const EnergyLedger& l)
{
  return l["kinetic"] + l["internal"] + l["hourglass"] + l["contact_stored"];
}

// A block whose lower side is held, and a fingertip above it that moves with a bone.
inline Model block_and_finger(double friction, bool sampled = false)
{
  BlockSettings settings;
  settings.voxels = { { 10, 8, 4 } };
  settings.damping = 100;
  Model model = block_model(settings);
  hold_plane(model, 2);
  model.bones = { "other", "finger" };
  const double radius = 4e-3;
  const std::array<double, 3> centre{ { 4e-3, 4e-3, 8.2e-3 } };
  Contact contact = touching_side(model, true, sphere_field(centre, radius));
  if (sampled)
  {
    const auto distance = [&](const std::array<double, 3>& p)
    { return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) - radius; };
    std::vector<std::array<double, 3>> near;
    for (int n = 0; n < 20; ++n)
      for (int m = 0; m < 40; ++m)
        for (const double r : { radius - 2e-3, radius, radius + 2e-3 })
          near.push_back({ { centre[0] + r * std::sin(9 * n * degree) * std::cos(9 * m * degree),
                             centre[1] + r * std::sin(9 * n * degree) * std::sin(9 * m * degree),
                             centre[2] + r * std::cos(9 * n * degree) } });
    contact.field = sample_field(near, distance, 0.125e-3, 1e-3);
    contact.reach = 2e-3;
  }
  contact.bone = 1;
  contact.friction = friction;
  model.contacts.push_back(contact);
  return model;
}

// Presses the finger in by 0.8 mm and moves it along x by 2 mm while it rotates.
inline void press_and_stroke(Solver& solver, double seconds)
{
  Controls controls = solver.controls();
  controls.bone[1] = rigid_motion({ { 0, 0, 0 } }, { { 0, 0, -1e-3 } });
  solver.advance(0.4 * seconds, controls);
  controls.bone[1] = rigid_motion({ { 0, 0.02, 0.01 } }, { { 2e-3, 0, -1e-3 } });
  solver.advance(0.6 * seconds, controls);
}

}  // namespace test
}  // namespace frontalis
