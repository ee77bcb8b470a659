#include "frontalis/study/statics.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

using namespace frontalis;

namespace
{

Model bar(double young, double poisson)
{
  VoxelBox box;
  box.size = { { 5, 2, 3 } };
  box.spacing = { { 1e-3, 2e-3, 1.5e-3 } };
  box.materials = { neo_hookean(young, poisson) };
  Model model = voxel_model(box);
  hold_mirror_planes(model);
  return model;
}

// A square sheet of 3 x 4 squares that a single voxel carries.
Model sheet(double side, double thickness, double young)
{
  Model model = voxel_model({ { 1, 1, 1 } }, side, neo_hookean(young, 0.3));
  Shell shell;
  shell.name = "sheet";
  shell.thickness = thickness;
  shell.surface = grid_mesh(3, 4, [side](double s, double t) { return Point{ { s * side, t * side, 0 } }; });
  shell.binding = bind_points(model, shell.surface.vertices);
  model.shells = { shell };
  return model;
}

}  // namespace

TEST(LinearStatics, PullsABarAsHookesLawSays)
{
  const Model model = bar(1e5, 0.3);
  const Vectors u = LinearStatics(model).solve(face_forces(model, 0, 5, { { 100, 0, 0 } }));
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto p = rest_position(model, n);
    EXPECT_NEAR(u[n][0], 1e-3 * p[0], 1e-10);
    EXPECT_NEAR(u[n][1], -0.3e-3 * p[1], 1e-10);
    EXPECT_NEAR(u[n][2], -0.3e-3 * p[2], 1e-10);
  }
}

TEST(LinearStatics, TakesPrescribedDisplacements)
{
  Model model = bar(1e5, 0.3);
  prescribe(model, nodes_where(model, [](const auto& p) { return p[0] > 4.5e-3; }), { { true, false, false } },
            { { 5e-6, 0, 0 } });
  const Vectors u = LinearStatics(model).solve(Vectors(model.nodes.size()));
  for (std::size_t n = 0; n < u.size(); ++n)
    EXPECT_NEAR(u[n][0], 1e-3 * rest_position(model, n)[0], 1e-10);
}

// A shell that its voxel does not hold is stretched as a sheet of its own.
TEST(LinearStatics, PullsAShellAlone)
{
  constexpr double side = 2e-3, thickness = 1e-4, young = 1e6, stress = 100;
  const Model model = sheet(side, thickness, young);
  const Vectors& at = model.shells[0].surface.vertices;
  Vectors forces(at.size());
  std::vector<std::array<bool, 3>> fixed;
  for (std::size_t v = 0; v < at.size(); ++v)
  {
    fixed.push_back({ { at[v][0] == 0, at[v][1] == 0, true } });
    if (at[v][0] > 0.99 * side)
      forces[v][0] = stress * thickness * side / (at[v][1] == 0 || at[v][1] > 0.99 * side ? 8 : 4);
  }
  const Vectors u = LinearStatics(model, fixed).solve(forces);
  for (std::size_t v = 0; v < at.size(); ++v)
  {
    EXPECT_NEAR(u[v][0], stress / young * at[v][0], 1e-12);
    EXPECT_NEAR(u[v][1], -0.3 * stress / young * at[v][1], 1e-12);
    EXPECT_EQ(u[v][2], 0);
  }
}

TEST(LinearStatics, RefusesWhatIsNotOfEveryPoint)
{
  const Model model = sheet(2e-3, 1e-4, 1e6);
  const std::size_t vertices = model.shells[0].surface.vertices.size();
  const auto held = [](std::size_t count) { return std::vector<std::array<bool, 3>>(count, { { true, true, true } }); };
  for (const std::size_t count : { std::size_t(0), vertices - 1, vertices + 1 })
  {
    EXPECT_THROW(LinearStatics(model, held(count)), Error) << count;
    EXPECT_THROW(LinearStatics(model, held(vertices)).solve(Vectors(count)), Error) << count;
  }
  EXPECT_NO_THROW(LinearStatics(model, held(vertices)).solve(Vectors(vertices)));
  const Model block = bar(1e5, 0.3);
  EXPECT_THROW(LinearStatics(block).solve(Vectors(block.nodes.size() - 1)), Error);
}

TEST(LinearStatics, RefusesShellsAloneOfAModelWithoutShells)
{
  EXPECT_THROW(LinearStatics(bar(1e5, 0.3), std::vector<std::array<bool, 3>>()), Error);
}

TEST(LinearStatics, FindsWhatIsUnstable)
{
  const Model model = bar(1e5, 0.3);
  EXPECT_TRUE(LinearStatics(model).positive_definite());
  const LinearStatics crushed(model, { { -0.2, 0, 0, 0, 1, 0, 0, 0, 1 } });
  EXPECT_FALSE(crushed.positive_definite());
  EXPECT_THROW(crushed.solve(Vectors(model.nodes.size())), Error);
}

TEST(LinearStatics, FaceForcesAddUpToTractionTimesArea)
{
  const Model model = bar(1e5, 0.3);
  double sum = 0;
  for (const auto& f : face_forces(model, 1, 0, { { 0, 2, 0 } }))
    sum += f[1];
  EXPECT_NEAR(sum, 2 * 5e-3 * 4.5e-3, 1e-15);
}
