#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// Position of the ridge of a roof, which is two planes that meet along y.
constexpr std::array<double, 2> ridge{ { 10e-3, -3e-3 } };  // x, z [m]

// Exact distance from p, above the roof, to its surface.
double roof_distance(double slope, const std::array<double, 3>& p)
{
  const double x = p[0] - ridge[0], z = p[2] - ridge[1], length = std::sqrt(1 + slope * slope);
  double best = std::hypot(x, z);
  for (const double side : { -1.0, 1.0 })
  {
    const double along = (side * x - slope * z) / length;
    if (along > 0)
      best = std::min(best, std::abs(slope * side * x + z) / length);
  }
  return best;
}

}  // namespace

class Sliding : public test::EveryBackend
{
};

TEST_P(Sliding, KeepsItsLevelOverARidge)
{
  const double slope = 0.4;
  test::BlockSettings s;
  s.voxels = { { 8, 2, 2 } };
  s.damping = 50;
  s.young = 3e3;
  Model model = test::block_model(s);
  // The nodes of the underside are 3 mm above the roof.
  slide_on(
      model, "roof", [&](const auto& p) { return roof_distance(slope, p); }, test::plane_of_nodes(model, 2), 0.5e-3,
      40e-3);
  model.gravity = { { 40.0, 0, 0 } };  // gravity drags the body along x over the ridge
  const auto solver_ = solver(model);
  double worst = 0, off_roof = 0, travelled = 0;
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
      worst = std::max(worst, std::abs(level_at(model.constraint_surfaces[0].field, p) - node.distance));
      off_roof = std::max(off_roof, std::abs(roof_distance(slope, p) - node.distance));
      travelled = std::max(travelled, u[node.node][0]);
    }
  }
  EXPECT_GT(travelled, 10e-3);
  EXPECT_LT(worst, 5e-6);
  EXPECT_LT(off_roof, 0.1e-3);
}

// With friction a node's plane turns with its level set, but not past the samples.
TEST_P(Sliding, PastItsFieldANodeWithFrictionStaysOnItsLatestPlane)
{
  test::BlockSettings s;
  s.voxels = { { 6, 4, 2 } };
  Model model = test::block_model(s);
  model.gravity = { { 9.81, 0, 0 } };
  // A cylinder of 40 mm that ends shortly before the front of the block.
  const auto cylinder = [](const auto& p)
  { return SurfaceDistance(std::hypot(p[0] - 4e-3, p[2] + 40e-3) - 40e-3, std::max(0.0, p[0] - 9e-3)); };
  const std::vector<std::int32_t> base = test::plane_of_nodes(model, 2);
  slide_on(model, "cylinder", cylinder, base, 0.25e-3);
  model.constraint_surfaces[0].friction = 0.05;
  const std::int32_t front = *std::max_element(
      base.begin(), base.end(), [&](auto a, auto b) { return test::rest(model, a)[0] < test::rest(model, b)[0]; });
  const auto solver = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0 });
  std::vector<std::pair<double, double>> path;  // beyond the samples
  Vectors u;
  for (int i = 0; i < 200 && (path.empty() || path.back().first < 17e-3); ++i)
  {
    solver->advance(0.5e-3, {});
    solver->displacements(u);
    if (const double x = test::rest(model, front)[0] + u[front][0]; x > 13.5e-3)
      path.emplace_back(x, u[front][2]);
  }
  ASSERT_GT(path.size(), 3U);
  const auto slope = [&](std::size_t i)
  { return (path[i + 1].second - path[i].second) / (path[i + 1].first - path[i].first); };
  EXPECT_LT(slope(0), -0.1);
  EXPECT_NEAR(slope(path.size() - 2), slope(0), 2e-3) << "a cylinder's slope changes by 0.08 on this way";
}

// A cap slides on a ball. Its rows have all lengths, so that the kernel processes nodes one by one and in batches.
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
  std::vector<std::int32_t> inside;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (const auto& at = model.nodes[n]; from_centre(at[0], at[1], at[2]) - radius < 0.6e-3)
      inside.push_back(static_cast<std::int32_t>(n));
  slide_on(
      model, "ball", [&](const auto& p) { return from_centre(1e3 * p[0], 1e3 * p[1], 1e3 * p[2]) - radius; }, inside);
  model.gravity = { { 30.0, -20.0, 9.81 } };
  for (const double friction : { 0.0, 0.3 })
  {
    model.constraint_surfaces[0].friction = friction;
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
      // Each solver may be 5 um off the level, because solvers change planes in different steps.
      EXPECT_LT(worst, 10e-6) << instructions << " " << friction;
    }
  }
}

FRONTALIS_EVERY_BACKEND(Sliding);
