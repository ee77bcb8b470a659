// Voxels that are partly filled, with their stress at the centroid of the tissue.

#include "backends.hpp"
#include "block_model.hpp"
#include "effect_scene.hpp"
#include "true_frequency.hpp"

#include "frontalis/model/effects.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace frontalis;
using test::Vectors;

namespace
{

// Gives voxels random centroids of their tissue; about a third of the voxels are whole.
void scatter_centres(Model& model)
{
  std::mt19937 random(17);
  std::uniform_real_distribution<float> value(-0.9F, 0.9F);
  model.tissue_centre.resize(model.voxels.size());
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (e % 3 != 0)
    {
      model.tissue_centre[e] = { value(random), value(random), value(random) };
      model.fill[e] = 0.05F + 0.5F * std::abs(value(random));
    }
}

// A block of 4 x 3 x 3 voxels, most of which are cut.
Model cut_block(HourglassControl hourglass = HourglassControl::scalar, const test::BlockSettings& settings = {})
{
  test::BlockSettings s = settings;
  s.voxels = { { 4, 3, 3 } };
  Model model = test::block_model(s);
  model.hourglass = hourglass;
  scatter_centres(model);
  return model;
}

class CutVoxels : public test::EveryBackend
{
protected:
  // Compares the motion of a model, with its muscles half active, with that on the reference backend.
  void expect_reference_motion(const Model& model, const char* what) const
  {
    std::vector<Vectors> found;
    for (const Backend& backend : { GetParam(), Backend("reference") })
    {
      const auto solver_ = make_solver(std::make_shared<const Model>(model), { backend, 2, 2e-6 });
      Controls controls = solver_->controls();
      std::fill(controls.activation.begin(), controls.activation.end(), 0.5F);
      solver_->advance(2e-3, controls);
      solver_->displacements(found.emplace_back());
    }
    const double size = test::largest(found[1]);
    EXPECT_GT(size, 1e-6) << what;
    for (std::size_t n = 0; n < found[0].size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[0][n][axis], found[1][n][axis], 1e-4 * size) << what;
  }
};

// the highest squared frequency of one voxel over its bound, in a random state of deformation
double true_over_bound(const Model& model, double amplitude)
{
  std::vector<std::size_t> free(24);
  std::iota(free.begin(), free.end(), 0);
  return test::true_over_bound(model, test::random_vectors(model, amplitude), std::vector<double>(8, 1e-6 / 8), free);
}

}  // namespace

// Energies are computed from transformed displacements. The reference backend computes forces independently of them,
// from shape functions at the centroid.
TEST_P(CutVoxels, ForcesAreTheGradientOfTheEnergy)
{
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
  {
    const Model model = cut_block(hourglass);
    test::expect_forces_from_energy(model, *solver(model), test::random_vectors(model, 1.5e-4), 3);
  }
}

TEST_P(CutVoxels, MoveAsInTheReference)
{
  Model model = cut_block();
  for (std::int32_t n = 0; n < 20; ++n)
    model.rigid.push_back({ n, -1, -1 });
  model.gravity = { { 2, 1, -9.81 } };
  expect_reference_motion(model, "neo-Hookean");
}

TEST_P(CutVoxels, MoveAsInTheReferenceWithOtherEffects)
{
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
    for (const unsigned effects :
         std::initializer_list<unsigned>{ test::viscosity, test::contraction, test::other_law, test::but_friction })
    {
      Model model = test::scene_of(effects | test::gravity, hourglass);
      scatter_centres(model);
      expect_reference_motion(model, std::to_string(effects).c_str());
    }
}

// The bound at nodes sets the step. On a GPU a kernel of its own finds it for each plan of steps.
TEST_P(CutVoxels, HaveTheStepOfTheReference)
{
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
  {
    Model model = cut_block(hourglass);
    for (std::int32_t n = 0; n < 20; ++n)
      model.rigid.push_back({ n, -1, -1 });
    model.gravity = { { 600, 300, -2943 } };
    double step[2], critical[2], before = 0;
    for (int b = 0; b < 2; ++b)
    {
      const auto solver_ =
          make_solver(std::make_shared<const Model>(model), { b == 0 ? GetParam() : "reference", 2, 0 });
      before = solver_->time_step();
      solver_->advance(4e-3, solver_->controls());
      step[b] = solver_->time_step();
      critical[b] = solver_->monitor().critical_time_step;
    }
    EXPECT_NEAR(critical[0] / critical[1], 1, 1e-3);
    EXPECT_NEAR(step[0] / step[1], 1, 0.01);
    EXPECT_GT(std::abs(step[1] / before - 1), 0.01) << "the tissue stiffens";
  }
}

// Under a uniform strain the stress at the centroid equals that at the centre, wherever the centroid is.
TEST_P(CutVoxels, UniformStrainHasTheEnergyOfWholeVoxels)
{
  const Model cut = cut_block();
  Model whole = cut;
  whole.tissue_centre.clear();
  Vectors u(cut.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto p = test::rest(cut, n);
    u[n] = { { 0.1 * p[0] + 0.05 * p[1], -0.08 * p[1] + 0.02 * p[2], 0.03 * p[0] } };
  }
  double energy[2];
  for (const bool with : { false, true })
  {
    const auto solver_ = solver(with ? cut : whole);
    solver_->set_displacements(u);
    energy[with ? 1 : 0] = solver_->monitor().internal;
  }
  EXPECT_NEAR(energy[1], energy[0], 1e-5 * energy[0]);
}

// At the bound of the time step the energy of a vibration does not grow.
TEST_P(CutVoxels, TheBoundOfTheTimeStepHolds)
{
  for (const double poisson : { 0.3, 0.49 })
  {
    test::BlockSettings settings;
    settings.poisson = poisson;
    Model model = cut_block(HourglassControl::scalar, settings);
    model.time_step_share = 0.99;
    const auto solver_ = solver(model);
    solver_->set_velocities(test::random_vectors(model, 1e-3));
    solver_->advance(0.002, solver_->controls());
    const auto energy = [&]
    {
      const Monitor monitor = solver_->monitor();
      return monitor.kinetic + monitor.internal + monitor.hourglass;
    };
    const double before = energy();
    solver_->advance(0.1, solver_->controls());
    EXPECT_LT(energy(), 1.3 * before) << poisson;
  }
}

FRONTALIS_EVERY_BACKEND(CutVoxels);

TEST(CutVoxel, HasNoHigherFrequencyThanTheBound)
{
  std::mt19937 random(23);
  std::uniform_real_distribution<float> value(-1, 1);
  double worst = 0;
  for (const double poisson : { 0, 1 })
    for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
      for (int i = 0; i < 60; ++i)
      {
        test::BlockSettings settings;
        settings.voxels = { { 1, 1, 1 } };
        settings.poisson = poisson > 0 ? 0.49 : 0.3;
        if (i % 2 == 0)
          settings.spacing = { { 1e-3, 1.3e-3, 0.8e-3 } };
        Model model = test::block_model(settings);
        model.hourglass = hourglass;
        model.materials[0].density = 1e-6 / (settings.spacing[0] * settings.spacing[1] * settings.spacing[2]);
        model.tissue_centre = { { value(random), value(random), value(random) } };
        if (i % 5 == 0)
          model.tissue_centre = { { 1, 1, -1 } };
        const double found = true_over_bound(model, i % 3 == 0 ? 1e-9 : 1e-4);
        EXPECT_LT(found, 1.02) << poisson << " " << i;
        worst = std::max(worst, found);
      }
  EXPECT_GT(worst, 0.7) << "far too careful";
}

// In a flat layer whose upper voxels are partly filled, the longest step is not much shorter than with whole voxels.
TEST(CutVoxel, ShortensTheStepLittle)
{
  test::BlockSettings settings;
  settings.voxels = { { 4, 4, 3 } };
  const double whole = make_solver(std::make_shared<const Model>(test::block_model(settings)), { "cpu", 1, 0 })
                           ->monitor()
                           .critical_time_step;
  for (const float fill : { 0.05F, 0.2F, 0.5F, 0.8F })
  {
    Model model = test::block_model(settings);
    model.tissue_centre.resize(model.voxels.size());
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      if (model.voxels[e][2] == 2)
      {
        model.fill[e] = fill;
        model.tissue_centre[e] = { 0, 0, fill - 1 };
      }
    const double step =
        make_solver(std::make_shared<const Model>(model), { "cpu", 1, 0 })->monitor().critical_time_step;
    EXPECT_GT(step, 0.9 * whole) << fill;
    EXPECT_LT(step, 1.001 * whole) << fill;
  }
}

TEST(CutVoxel, LeavesNothingBehindWhenSwitchedOff)
{
  Model model = cut_block();
  const EffectPresence presence = presence_of(model, Effect::cut_voxels);
  EXPECT_TRUE(presence.present);
  EXPECT_EQ(presence.voxels, 24U);
  switch_off(model, EffectSet().with(Effect::cut_voxels));
  EXPECT_TRUE(model.tissue_centre.empty());
}
