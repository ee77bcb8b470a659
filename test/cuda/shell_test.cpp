#include "cuda/bench/shell_model.hpp"
#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace frontalis;

namespace
{

// Compares backends on a curved layer of tissue with muscles, rigid nodes and sliding nodes.
class ShellModel : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto backends = available_backends();
    if (std::find(backends.begin(), backends.end(), "cuda") == backends.end())
      GTEST_SKIP() << "no CUDA device";
    ShellSettings settings;
    settings.voxel = 3e-3;
    settings.tendon = false;
    model_ = std::make_shared<const Model>(shell_model(settings));
  }

  SkinState after(Backend backend, double seconds, float activation, int slices = 1)
  {
    const auto solver = make_solver(model_, { backend, 0, 0 });
    for (int i = 0; i < slices; ++i)
      solver->advance(seconds / slices,
                      { std::vector<float>(model_->muscles.size(), activation * (i + 1) / slices), {} });
    SkinState skin;
    solver->skin(skin);
    return skin;
  }

  // Root mean square distance between two skins [m].
  static double difference(const SkinState& a, const SkinState& b)
  {
    double sum = 0;
    for (std::size_t v = 0; v < a.vertices.size(); ++v)
      for (int axis = 0; axis < 3; ++axis)
        sum += std::pow(double(a.vertices[v][axis]) - b.vertices[v][axis], 2);
    return std::sqrt(sum / static_cast<double>(a.vertices.size()));
  }

  std::shared_ptr<const Model> model_;
};

}  // namespace

TEST_F(ShellModel, MovesAsTheReferenceDoes)
{
  const SkinState reference = after("reference", 0.15, 1), cuda = after("cuda", 0.15, 1);
  SkinState rest;
  make_solver(model_, { "cuda", 0, 0 })->skin(rest);
  EXPECT_GT(difference(rest, reference), 0.5e-3);
  EXPECT_LT(difference(cuda, reference), 5e-6);
  double normals = 0;
  for (std::size_t v = 0; v < cuda.normals.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      normals = std::max(normals, std::abs(double(cuda.normals[v][axis]) - reference.normals[v][axis]));
  EXPECT_LT(normals, 1e-2);
  for (std::size_t l = 0; l < reference.landmarks.size(); ++l)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(cuda.landmarks[l][axis], reference.landmarks[l][axis], 1e-5);
}

// The model has no sliding nodes, because backends replace their planes at different times, which moves the skin by
// micrometres.
TEST_F(ShellModel, IsAsPreciseAsTheCpuWithoutSliding)
{
  Model model = *model_;
  for (const auto& node : model.sliding)
    if (node.node % 3 == 0)
      model.rigid.push_back({ node.node, -1 });
  model.sliding.clear();
  model_ = std::make_shared<const Model>(model);
  const SkinState reference = after("reference", 0.15, 1);
  const double cuda = difference(after("cuda", 0.15, 1), reference);
  EXPECT_LT(cuda, 5e-6);
  EXPECT_LT(cuda, 2 * difference(after("cpu", 0.15, 1), reference) + 1e-8);
}

TEST_F(ShellModel, GivesTheSameBitsFromRunToRun)
{
  const SkinState first = after("cuda", 0.05, 0.75f, 7), second = after("cuda", 0.05, 0.75f, 7);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.normals, second.normals);
  EXPECT_EQ(first.landmarks, second.landmarks);
}

TEST_F(ShellModel, FetchingTheSkinDoesNotChangeTheMotion)
{
  const auto run = [&](bool look)
  {
    const auto solver = make_solver(model_, { "cuda", 0, 0 });
    SkinState skin;
    for (int i = 0; i < 10; ++i)
    {
      solver->advance(5e-3, { std::vector<float>(model_->muscles.size(), 0.08f * (i + 1)), {} });
      if (look)
        solver->skin(skin);
    }
    solver->skin(skin);
    return skin;
  };
  EXPECT_EQ(run(true).vertices, run(false).vertices);
}

TEST_F(ShellModel, StartsAgainAfterReset)
{
  const auto solver = make_solver(model_, { "cuda", 0, 0 });
  const Controls controls{ std::vector<float>(model_->muscles.size(), 0.5f), {} };
  SkinState first, second;
  solver->advance(0.02, controls);
  solver->skin(first);
  solver->reset();
  EXPECT_EQ(solver->time(), 0);
  solver->advance(0.02, controls);
  solver->skin(second);
  EXPECT_EQ(first.vertices, second.vertices);
}

// The model is small, so that the test can run under compute-sanitizer's racecheck.
TEST_F(ShellModel, OfAFewVoxelsMovesAsTheReferenceDoes)
{
  ShellSettings settings;
  settings.voxel = 5e-3;
  settings.tendon = false;
  model_ = std::make_shared<const Model>(shell_model(settings));
  const double seconds = 20 * make_solver(model_, { "cuda", 0, 0 })->time_step();
  const SkinState reference = after("reference", seconds, 1), cuda = after("cuda", seconds, 1);
  SkinState rest;
  make_solver(model_, { "cuda", 0, 0 })->skin(rest);
  EXPECT_GT(difference(rest, reference), 1e-9);
  EXPECT_LT(difference(cuda, reference), 1e-3 * difference(rest, reference));
}

// The model is at equilibrium under gravity and 30 % activation.
TEST_F(ShellModel, StaysWhereItIsForAMillionSteps)
{
  Model model = *model_;
  model.gravity = { { -9.81, 0, 0 } };
  const auto solver = make_solver(std::make_shared<const Model>(model), { "cuda", 0, 0 });
  const Controls controls{ std::vector<float>(model.muscles.size(), 0.3f), {} };
  SkinState rest, first, last;
  solver->skin(rest);
  ASSERT_TRUE(solver->settle(controls, 1e-4, 10).reached);
  solver->advance(0.5, controls);
  solver->skin(first);
  const auto before = solver->profile().steps;
  while (solver->profile().steps - before < 1000000)
    solver->advance(0.5, controls);
  solver->skin(last);
  EXPECT_GT(difference(rest, first), 0.1e-3);
  double drift = 0;
  for (std::size_t v = 0; v < first.vertices.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      drift = std::max(drift, std::abs(double(last.vertices[v][axis]) - first.vertices[v][axis]));
  EXPECT_LT(drift, 1e-6);
  std::printf("drift %.3f um\n", 1e6 * drift);
}
