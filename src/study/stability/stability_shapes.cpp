// Hard cases of shapes: crushed, twisted, scrambled, turning, dangling, nearly empty and slender voxels.

#include "frontalis/physics/number.hpp"
#include "frontalis/study/statics.hpp"
#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

// Checks that the stored energy has been released and voxels have regained their volumes.
void expect_rest(CaseRun& run, GuardedTrial& motion, const std::string& of, double stored_before)
{
  const Monitor& m = motion.monitor();
  run.check("stored energy left, " + of, "1", 0, (m.internal + m.hourglass) / stored_before, "stored_left");
  run.check("final smallest J, " + of, "1", 1, m.worst_jacobian, "smallest_J");
}

// Releases a block from imposed displacements [m].
void let_go(CaseRun& run, const Model& model, const Vectors& displacements, int parts, const std::string& of,
            const std::string& picture, const std::string& title)
{
  GuardedTrial motion(run, model);
  motion.set(displacements);
  const double stored = motion.energies().initial;
  motion.advance({ run.seconds("watched"), motion.controls(), parts });
  motion.check_balance(of, picture, title);
  motion.advance({ run.seconds("rest"), motion.controls(), 10 });
  expect_rest(run, motion, of, stored);
}

void crushed(CaseRun& run)
{
  Model model = damped_block(run);
  hold_ends(model, 2, "press");
  GuardedTrial motion(run, model);
  const RigidTransform down = shifted({ { 0, 0, -0.01 * run.number("pressed_by", "%") * model.size[2] * 1e-3 } });
  const double press = run.seconds("press");
  motion.advance({ press, motion.controls(0, down), 20 });
  motion.advance({ run.seconds("hold"), motion.controls(0, down), 10 });
  const double stored = motion.energies()["internal"] + motion.energies()["hourglass"];
  motion.advance({ press, motion.controls(), 20 });
  motion.advance({ run.seconds("rest"), motion.controls(), 20 });
  motion.check_balance("pressed and let go", "crushed",
                       "A block is pressed to a tenth of its height in 20 ms, and back");
  expect_rest(run, motion, "pressed", stored);
}

void twisted(CaseRun& run)
{
  Model model = damped_block(run);
  hold_ends(model, 2, "grip");
  GuardedTrial motion(run, model);
  const Point axis{ { 0.5e-3 * model.size[0], 0.5e-3 * model.size[1], 0 } };
  double stored = 0;
  for (const int quarter : { 1, 2, 1, 0 })
  {
    const RigidTransform turned = turned_about({ { 0, 0, quarter * physics::pi / 2 } }, axis);
    motion.advance({ 0.5 * run.seconds("turn"), motion.controls(0, turned), 10 });
    if (quarter == 2)
      stored = motion.energies()["internal"] + motion.energies()["hourglass"];
  }
  motion.advance({ run.seconds("rest"), motion.controls(), 20 });
  motion.check_balance("turned by 180° and back", "twisted", "A bar's end is turned by 180° in 20 ms, and back");
  expect_rest(run, motion, "twisted", stored);
}

void released(CaseRun& run)
{
  const Model model = damped_block(run);
  const std::pair<std::string, std::function<Point(const Point&)>> shapes[] = {
    { "pressed",
      [](const Point& p) {
        return Point{ { 0, 0, 0.1 * p[2] - p[2] } };
      } },
    { "twisted",
      [&](const Point& p)
      {
        const double turn = physics::pi * p[2] / (1e-3 * model.size[2]), c = std::cos(turn), s = std::sin(turn);
        const double x = p[0] - 0.5e-3 * model.size[0], y = p[1] - 0.5e-3 * model.size[1];
        return Point{ { c * x - s * y - p[0], s * x + c * y - p[1], 0 } };
      } }
  };
  for (const auto& [name, displacement] : shapes)
  {
    Vectors u;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      u.push_back(displacement(rest_position(model, n)));
    let_go(run, model, u, 50, name, "released_" + name, "A free block is let go, " + name);
  }
}

void scrambled(CaseRun& run)
{
  struct Form
  {
    std::string file, name;
    HourglassControl hourglass;
    Integration integration;
  };
  for (const Form& form :
       { Form{ "scalar", "scalar hourglass control", HourglassControl::scalar, Integration::one_point },
         Form{ "assumed_strain", "assumed strain", HourglassControl::assumed_strain, Integration::one_point },
         Form{ "selective_reduced", "eight points", HourglassControl::scalar, Integration::selective_reduced } })
  {
    Model model = damped_block(run);
    model.hourglass = form.hourglass;
    model.integration = form.integration;
    std::mt19937 random(7);
    // The displacements have equal lengths and random directions.
    Vectors u(model.nodes.size());
    for (auto& p : u)
    {
      double length = 0;
      do
      {
        for (double& x : p)
          x = drawn_from(random);
        length = std::hypot(p[0], p[1], p[2]);
      } while (length > 1 || length < 0.1);
      for (double& x : p)
        x *= 1e-3 * run.number("moved_by", "mm") / length;
    }
    let_go(run, model, u, 40, form.name, "scrambled_" + form.file,
           "Every node of a block moved by half a voxel, " + form.name);
  }
}

void rigid_rotation(CaseRun& run)
{
  const Model model = voxel_model(run.size(), 1e-3, soft_tissue());
  const double rate = 2 * physics::pi * run.number("rate", "1/s");
  Vectors u(model.nodes.size()), v;
  const double third = 1 / std::sqrt(3.0);
  const auto middle = 0.5e-3 * vector_of(model.size);
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto turning = rate * cross({ third, third, third }, vector_of(rest_position(model, n)) - middle);
    v.push_back(array_of(turning));
  }
  GuardedTrial motion(run, model);
  motion.set(u, v);
  const double kinetic = motion.energies()["kinetic"];
  motion.advance({ run.number("turns") * 2 * physics::pi / rate, motion.controls(), 50 });
  motion.check_balance("ten turns", "rigid_rotation", "A free block turns ten times");
  run.check_relative("kinetic energy after ten turns", "uJ", 1e6 * kinetic, 1e6 * motion.energies()["kinetic"],
                     "kinetic_energy");
  // A rigid motion keeps the distance between opposite nodes.
  const auto now = motion.displacements();
  double worst = 0;
  for (std::size_t n = 0; n < now.size(); ++n)
  {
    const std::size_t opposite = now.size() - 1 - n;
    const auto before = vector_of(rest_position(model, n)) - vector_of(rest_position(model, opposite));
    const auto after = before + vector_of(now[n]) - vector_of(now[opposite]);
    if (norm(before) > 0)
      worst = std::max(worst, std::abs(norm(after) / norm(before) - 1));
  }
  run.check("change of a diagonal", "%", 0, 100 * worst, "diagonal");
}

void dangling(CaseRun& run)
{
  VoxelBox box{ run.size(), { { 1e-3, 1e-3, 1e-3 } }, { soft_tissue() } };
  // The model is a fixed slab to which a sheet, a strip and two single voxels are attached, one voxel by an edge and
  // one by a corner, and a free voxel.
  box.fill = [](const Voxel& v) -> double
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
  GuardedTrial motion(run, model);
  const double seconds = run.seconds("fall");
  motion.advance({ seconds, motion.controls(), 50 });
  motion.check_balance("hanging and falling", "dangling",
                       "A sheet, a strip and single voxels hang by faces, an edge and a corner; one falls");
  const auto alone = nodes_where(model, [](const auto& p) { return p[2] < 1.5e-3; });
  run.check_relative("fall of the free voxel", "mm", -1e3 * 0.5 * 9.81 * seconds * seconds,
                     1e3 * mean_displacement(motion.displacements(), alone)[2], "fall");
}

// Length of the longest edge of the voxels with little tissue, in voxel edges.
double longest_edge_of_slivers(const Model& model, const Vectors& u)
{
  double longest = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (std::size_t corner = 0; corner < 8 && model.fill[e] < 0.5F; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const std::size_t from = model.voxel_nodes[e][corner & ~(std::size_t{ 1 } << axis)];
        const std::size_t to = model.voxel_nodes[e][corner | std::size_t{ 1 } << axis];
        const auto edge = vector_of(rest_position(model, to)) + vector_of(u[to]) -
                          vector_of(rest_position(model, from)) - vector_of(u[from]);
        longest = std::max(longest, norm(edge) / model.spacing[axis]);
      }
  return longest;
}

void slivers(CaseRun& run)
{
  VoxelBox box{ run.size(), { { 1e-3, 1e-3, 1e-3 } }, { soft_tissue() } };
  const double fill = run.number("fill");
  // a block whose top layer has holes of 2 x 2 voxels with a sliver in one corner
  box.fill = [&](const Voxel& v) -> double
  {
    const bool hole = v[2] + 1 == box.size[2] && v[0] % 4 > 1 && v[1] % 4 > 1;
    return !hole ? 1 : v[0] % 4 == 2 && v[1] % 4 == 2 ? fill : 0;
  };
  Model model = voxel_model(box);
  model.damping = run.number("damping", "1/s");
  hold_face(model, 0, false);
  hold_face(model, 0, true, "press");
  GuardedTrial motion(run, model);
  const RigidTransform in = shifted({ { -0.01 * run.number("pressed_by", "%") * model.size[0] * 1e-3, 0, 0 } });
  double longest = 0;
  for (const RigidTransform& pose : { in, RigidTransform() })
    for (int part = 0; part < 100; ++part)
    {
      motion.advance({ 0.01 * run.seconds("watched"), motion.controls(0, pose) });
      longest = std::max(longest, longest_edge_of_slivers(model, motion.displacements()));
    }
  run.check("longest edge of a sliver", "1", 1, longest, "edge");
  motion.check_balance("pressed at once and let go", "slivers",
                       "A block with slivers in its top layer is pressed at once, and let go");
  motion.advance({ run.seconds("rest"), motion.controls(), 10 });
  run.check("remaining displacement", "mm", 0, 1e3 * farthest(motion.displacements()), "left");
}

void slender(CaseRun& run)
{
  for (const bool long_way : { true, false })
  {
    const std::vector<double> edges = run.numbers("edges", "mm", 3);
    Model model = voxel_model({ run.size(long_way ? "size_along" : "size_across"),
                                { { 1e-3 * edges[0], 1e-3 * edges[1], 1e-3 * edges[2] } },
                                { soft_tissue() } });
    const std::string name = long_way ? "hung along the long edges" : "hung across them";
    const std::size_t along = long_way ? 2 : 0;
    const double length = model.size[along] * model.spacing[along];
    hold_face(model, static_cast<int>(along), true);
    model.gravity[along] = -9.81;
    GuardedTrial motion(run, model);
    motion.advance({ run.seconds("swing"), motion.controls(), 20 });
    motion.check_balance(name, long_way ? "slender_along" : "slender_across",
                         "Voxels of 1 × 1 × 10 mm, " + name + " at once");
    motion.settle(motion.controls());
    const auto end = nodes_where(model, [&](const auto& p) { return p[along] < 0.1e-3; });
    run.check_relative("lengthening, " + name, "um", -1e6 * 1000 * 9.81 * length * length / (2 * 34e3),
                       1e6 * mean_displacement(motion.displacements(), end)[along], "lengthening");
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
           { "slivers", slivers },
           { "slender", slender } };
}

}  // namespace frontalis
