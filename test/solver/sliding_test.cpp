#include "backends.hpp"
#include "block_model.hpp"
#include "sphere_mesh.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// A roof of two planes that meet in a ridge along y, finely triangulated across it.
TriangleMesh roof(double slope)
{
  TriangleMesh mesh;
  const double half = 40e-3;
  for (const double y : { -half, half })
    for (const double x : { -half, 0.0, half })
      mesh.vertices.push_back({ { x + 10e-3, y, -slope * std::abs(x) } });
  mesh.triangles = { { { 0, 1, 3 } }, { { 1, 4, 3 } }, { { 1, 2, 4 } }, { { 2, 5, 4 } } };
  return mesh;
}

// Exact distance from p, above the roof, to its surface.
double roof_distance(double slope, const std::array<double, 3>& p)
{
  const double x = p[0] - 10e-3, length = std::sqrt(1 + slope * slope);
  double best = std::hypot(x, p[2]);
  for (const double side : { -1.0, 1.0 })
  {
    const double along = (side * x - slope * p[2]) / length;
    if (along > 0)
      best = std::min(best, std::abs(slope * side * x + p[2]) / length);
  }
  return best;
}

}  // namespace

class Sliding : public test::EveryBackend
{
};

TEST_P(Sliding, KeepsItsDistanceOverARidge)
{
  const double slope = 0.4;
  test::BlockSettings s;
  s.voxels = { { 8, 2, 2 } };
  s.damping = 50;
  s.young = 3e3;
  Model model = test::block_model(s);
  model.constraint_surfaces.push_back({ "roof", roof(slope) });
  // the underside lies 3 mm above the roof
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] == 0)
      model.sliding.push_back({ static_cast<std::int32_t>(n), 0, 0 });
  for (auto& vertex : model.constraint_surfaces[0].mesh.vertices)
    vertex[2] -= 3e-3;
  for (auto& node : model.sliding)
  {
    auto p = test::rest(model, node.node);
    p[2] += 3e-3;
    node.distance = roof_distance(slope, p);
  }
  model.gravity = { { 40.0, 0, 0 } };  // drags the body along x over the ridge
  const auto solver_ = solver(model);
  double worst = 0, travelled = 0;
  for (int i = 0; i < 40; ++i)
  {
    solver_->advance(2e-3, {});
    Vectors u;
    solver_->displacements(u);
    for (const auto& node : model.sliding)
    {
      auto p = test::rest(model, node.node);
      for (int axis = 0; axis < 3; ++axis)
        p[axis] += u[node.node][axis];
      p[2] += 3e-3;
      worst = std::max(worst, std::abs(roof_distance(slope, p) - node.distance));
      travelled = std::max(travelled, u[node.node][0]);
    }
  }
  EXPECT_GT(travelled, 10e-3);
  EXPECT_LT(worst, 10e-6);
}

// A cap slides on the ball. Its rows have every length, so that nodes are processed one by one and many at a time.
TEST(SlidingKernels, AreAlikeOnAnyNumberOfThreadsAndCloseOnEachInstructionSet)
{
  const double radius = 9.6e-3;
  test::BlockSettings s;
  s.voxels = { { 24, 24, 24 } };
  s.damping = 20;
  const auto from_centre = [](double i, double j, double k) { return 1e-3 * std::hypot(i - 12, j - 12, k - 12); };
  s.keep = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  {
    const double r = from_centre(i + 0.5, j + 0.5, k + 0.5);
    return k > 10 && r > radius && r < radius + 1.8e-3;
  };
  Model model = test::block_model(s);
  model.constraint_surfaces.push_back({ "ball", test::sphere(radius, { { 12e-3, 12e-3, 12e-3 } }, 12) });
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const auto& at = model.nodes[n];
    const double distance = from_centre(at[0], at[1], at[2]) - radius;
    if (distance < 0.6e-3)
      model.sliding.push_back({ static_cast<std::int32_t>(n), 0, distance });
  }
  model.gravity = { { 30.0, -20.0, 9.81 } };
  const auto run = [&](const char* instructions, int threads)
  {
    ::setenv("FRONTALIS_INSTRUCTION_SET", instructions, 1);
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", threads, 0 });
    ::unsetenv("FRONTALIS_INSTRUCTION_SET");
    solver->advance(15e-3, {});
    Vectors u;
    solver->displacements(u);
    return u;
  };
  const Vectors plain = run("baseline", 1);
  EXPECT_GT(plain.size(), 500u);
  for (const char* instructions : { "baseline", "avx2", "avx512" })
  {
    Vectors one;
    try
    {
      one = run(instructions, 1);
    }
    catch (const Error&)
    {
      continue;  // this machine lacks the instruction set
    }
    for (const int threads : { 2, 3, 4 })
      EXPECT_EQ(run(instructions, threads), one) << instructions << " " << threads;
    double worst = 0, largest = 0;
    for (std::size_t n = 0; n < one.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        worst = std::max(worst, std::abs(one[n][axis] - plain[n][axis]));
        largest = std::max(largest, std::abs(one[n][axis]));
      }
    EXPECT_GT(largest, 1e-3);
    // each solver may be off the surface by 10 um, because planes change in different steps
    EXPECT_LT(worst, 20e-6) << instructions;
  }
}

FRONTALIS_EVERY_BACKEND(Sliding);
