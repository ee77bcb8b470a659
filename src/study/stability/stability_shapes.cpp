// hard cases of shapes: crushed, twisted, scrambled, turning, dangling and slender voxels

#include "frontalis/study/equilibrium.hpp"
#include "study/stability/stability_cases.hpp"
#include "study/stability/stability_models.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

const double pi = std::acos(-1.0);

using Point = std::array<double, 3>;

// checks that the stored energy is gone and the voxels have their volumes again
void expect_rest(const CaseFile& file, Trial& trial, GuardedTrial& motion, const std::string& of, double stored_before)
{
  const Monitor& m = motion.monitor();
  trial.checks.absolute("stored energy left, " + of, "1", 0, (m.internal + m.hourglass) / stored_before,
                        file.bound("stored_left"));
  trial.checks.absolute("smallest J in the end, " + of, "1", 1, m.worst_jacobian, file.bound("smallest_J"));
}

void crushed(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  hold_face(model, 2, false);
  hold_face(model, 2, true, "press");
  GuardedTrial motion(settings, trial, model);
  const RigidTransform down{ RigidTransform().rotation,
                             { { 0, 0, -0.01 * file.number("pressed_by", "%") * model.size[2] * 1e-3 } } };
  const double press = file.seconds("press");
  motion.advance(press, motion.controls(0, down), 20);
  motion.advance(file.seconds("hold"), motion.controls(0, down), 10);
  const double stored = motion.energies().internal + motion.energies().hourglass;
  motion.advance(press, motion.controls(), 20);
  motion.advance(file.seconds("rest"), motion.controls(), 20);
  motion.check_balance(file, "pressed and let go", "crushed",
                       "A block is pressed to a tenth of its height in 20 ms, and back");
  expect_rest(file, trial, motion, "pressed", stored);
}

void twisted(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  hold_face(model, 2, false);
  hold_face(model, 2, true, "grip");
  GuardedTrial motion(settings, trial, model);
  const Point axis{ { 0.5e-3 * model.size[0], 0.5e-3 * model.size[1], 0 } };
  const double quarter_turn = 0.5 * file.seconds("turn");
  for (const int quarter : { 1, 2 })
    motion.advance(quarter_turn, motion.controls(0, turned_about({ { 0, 0, quarter * pi / 2 } }, axis)), 10);
  const double stored = motion.energies().internal + motion.energies().hourglass;
  for (const int quarter : { 1, 0 })
    motion.advance(quarter_turn, motion.controls(0, turned_about({ { 0, 0, quarter * pi / 2 } }, axis)), 10);
  motion.advance(file.seconds("rest"), motion.controls(), 20);
  motion.check_balance(file, "turned by 180° and back", "twisted", "A bar's end is turned by 180° in 20 ms, and back");
  expect_rest(file, trial, motion, "twisted", stored);
}

// a free block starts in a deformation that was forced on it, and is let go at once
void released(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  const auto size = file.size();
  const std::pair<std::string, std::function<Point(const Point&)>> shapes[] = {
    { "pressed",
      [](const Point& p) -> Point {
        return { { p[0], p[1], 0.1 * p[2] } };
      } },
    { "twisted",
      [&](const Point& p) -> Point
      {
        const double angle = pi * p[2] / (1e-3 * size[2]), x = p[0] - 0.5e-3 * size[0], y = p[1] - 0.5e-3 * size[1];
        return { { std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, p[2] } };
      } }
  };
  for (const auto& [name, map] : shapes)
  {
    Model model = soft_block(size);
    model.damping = file.number("damping", "1/s");
    GuardedTrial motion(settings, trial, model);
    motion.set(displaced(model, map));
    const double stored = motion.energies().initial;
    motion.advance(file.seconds("watched"), motion.controls(), 50);
    motion.check_balance(file, name, "released_" + name, "A free block is let go, " + name);
    motion.advance(file.seconds("rest"), motion.controls(), 10);
    expect_rest(file, trial, motion, name, stored);
  }
}

void scrambled(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  struct Form
  {
    const char *file, *name;
    HourglassControl hourglass;
    Integration integration;
  };
  for (const Form& form :
       { Form{ "scalar", "scalar hourglass control", HourglassControl::scalar, Integration::one_point },
         Form{ "assumed_strain", "assumed strain", HourglassControl::assumed_strain, Integration::one_point },
         Form{ "selective_reduced", "eight points", HourglassControl::scalar, Integration::selective_reduced } })
  {
    Model model = damped_block(file);
    model.hourglass = form.hourglass;
    model.integration = form.integration;
    std::mt19937 random(7);
    // half a voxel in a random direction
    Vectors u(model.nodes.size());
    for (auto& p : u)
    {
      double length = 0;
      do
      {
        for (double& x : p)
          x = 2 * (static_cast<double>(random()) / 4294967295.0) - 1;
        length = std::hypot(p[0], p[1], p[2]);
      } while (length > 1 || length < 0.1);
      for (double& x : p)
        x *= 1e-3 * file.number("moved_by", "mm") / length;
    }
    GuardedTrial motion(settings, trial, model);
    motion.set(u);
    const double stored = motion.energies().initial;
    motion.advance(file.seconds("watched"), motion.controls(), 40);
    motion.check_balance(file, form.name, std::string("scrambled_") + form.file,
                         std::string("Every node of a block moved by half a voxel, ") + form.name);
    motion.advance(file.seconds("rest"), motion.controls(), 10);
    expect_rest(file, trial, motion, form.name, stored);
  }
}

void rigid_rotation(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  const Model model = soft_block(file.size());
  const double rate = 2 * pi * file.number("rate", "1/s");
  Vectors u(model.nodes.size()), v(model.nodes.size());
  const std::array<double, 3> axis{ { 1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0) } };
  for (std::size_t n = 0; n < v.size(); ++n)
  {
    auto r = rest_position(model, n);
    for (std::size_t i = 0; i < 3; ++i)
      r[i] -= 0.5e-3 * model.size[i];
    for (std::size_t i = 0; i < 3; ++i)
      v[n][i] = rate * (axis[(i + 1) % 3] * r[(i + 2) % 3] - axis[(i + 2) % 3] * r[(i + 1) % 3]);
  }
  GuardedTrial motion(settings, trial, model);
  motion.set(u, v);
  const double kinetic = motion.energies().kinetic;
  motion.advance(file.number("turns") * 2 * pi / rate, motion.controls(), 50);
  motion.check_balance(file, "ten turns", "rigid_rotation", "A free block turns ten times");
  trial.checks.relative("kinetic energy after ten turns", "uJ", 1e6 * kinetic, 1e6 * motion.energies().kinetic,
                        0.01 * file.bound("kinetic_energy", "%"));
  // the shape is kept where the diagonals keep their lengths
  const auto now = motion.displacements();
  double worst = 0;
  for (std::size_t n = 0; n < now.size(); ++n)
  {
    const std::size_t opposite = now.size() - 1 - n;
    const auto a = rest_position(model, n), b = rest_position(model, opposite);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      before += (a[i] - b[i]) * (a[i] - b[i]);
      after += std::pow(a[i] + now[n][i] - b[i] - now[opposite][i], 2);
    }
    if (before > 0)
      worst = std::max(worst, std::abs(std::sqrt(after / before) - 1));
  }
  trial.checks.absolute("change of a diagonal", "%", 0, 100 * worst, file.bound("diagonal", "%"));
}

void dangling(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  VoxelBox box;
  box.size = file.size();
  box.materials = { soft_tissue() };
  // a held slab with a sheet, a strip, a voxel by its edge and a voxel by its corner on it; and one voxel that is free
  box.fill = [](const std::array<std::int32_t, 3>& v) -> double
  {
    const bool top = v[2] == 6;
    const bool slab = top && v[0] < 3 && v[1] < 9, sheet = top && v[1] < 3, strip = top && v[1] == 7;
    const bool edge = v[0] == 3 && v[1] == 5 && v[2] == 5, corner = v[0] == 3 && v[1] == 9 && v[2] == 5;
    const bool alone = v[0] == 8 && v[1] == 5 && v[2] == 0;
    return slab || sheet || strip || edge || corner || alone ? 1 : 0;
  };
  Model model = voxel_model(box);
  hold(model, [](const auto& p) { return p[2] > 5.5e-3 && p[0] < 2.5e-3; });
  model.gravity = { { 0, 0, -9.81 } };
  GuardedTrial motion(settings, trial, model);
  const double seconds = file.seconds("fall");
  motion.advance(seconds, motion.controls(), 50);
  motion.check_balance(file, "hanging and falling", "dangling",
                       "A sheet, a strip and single voxels hang by faces, an edge and a corner; one falls");
  const auto alone = nodes_where(model, [](const auto& p) { return p[2] < 1.5e-3; });
  trial.checks.relative("fall of the free voxel", "mm", -1e3 * 0.5 * 9.81 * seconds * seconds,
                        1e3 * mean_displacement(motion.displacements(), alone)[2], 0.01 * file.bound("fall", "%"));
}

void slender(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  for (const bool long_way : { true, false })
  {
    VoxelBox box;
    box.size = file.size(long_way ? "size_along" : "size_across");
    const std::vector<double> edges = file.numbers("edges", "mm", 3);
    for (std::size_t i = 0; i < 3; ++i)
      box.spacing[i] = 1e-3 * edges[i];
    box.materials = { soft_tissue() };
    Model model = voxel_model(box);
    const std::string name = long_way ? "hung along the long edges" : "hung across them";
    const std::size_t along = long_way ? 2 : 0;
    const double length = box.size[along] * box.spacing[along];
    hold_face(model, static_cast<int>(along), true);
    model.gravity[along] = -9.81;
    GuardedTrial motion(settings, trial, model);
    motion.advance(file.seconds("swing"), motion.controls(), 20);
    motion.check_balance(file, name, long_way ? "slender_along" : "slender_across",
                         "Voxels of 1 × 1 × 10 mm, " + name + " at once");
    motion.settle(motion.controls(), 1e-4, file.seconds("longest_settling"));
    const auto end = nodes_where(model, [&](const auto& p) { return p[along] < 0.1e-3; });
    trial.checks.relative("lengthening, " + name, "um", -1e6 * 1000 * 9.81 * length * length / (2 * 34e3),
                          1e6 * mean_displacement(motion.displacements(), end)[along],
                          0.01 * file.bound("lengthening", "%"));
  }
}

}  // namespace

CaseFunctions hard_shapes()
{
  return { { "crushed", crushed },
           { "twisted", twisted },
           { "released", released },
           { "scrambled", scrambled },
           { "rigid_rotation", rigid_rotation },
           { "dangling", dangling },
           { "slender", slender } };
}

}  // namespace frontalis
