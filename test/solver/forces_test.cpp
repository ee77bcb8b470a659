#include "backends.hpp"
#include "block_model.hpp"
#include "nodal_vectors.hpp"

#include <cmath>

using namespace frontalis;
using test::Vectors;

namespace
{

using Affine = std::array<std::array<double, 3>, 3>;

Vectors affine(const Model& model, const Affine& F)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto X = test::rest(model, n);
    for (int i = 0; i < 3; ++i)
      u[n][i] = F[i][0] * X[0] + F[i][1] * X[1] + F[i][2] * X[2] - X[i];
  }
  return u;
}

// A block with a hole and an uneven edge, so that rows of voxels are interrupted.
test::BlockSettings ragged()
{
  test::BlockSettings s;
  s.voxels = { { 21, 5, 4 } };
  s.spacing = { { 1e-3, 1.2e-3, 0.8e-3 } };
  s.keep = [](int i, int j, int k) { return !(i == 7 && j == 2) && !(k == 3 && i > 12) && !(i == 20 && j == 0); };
  return s;
}

}  // namespace

class Forces : public test::EveryBackend
{
};

TEST_P(Forces, RigidMotionGivesNone)
{
  const Model model = test::block_model(ragged());
  const double a = 0.7, c = std::cos(a), s = std::sin(a);
  Vectors u = affine(model, { { { { c, -s, 0 } }, { { s, c, 0 } }, { { 0, 0, 1 } } } });
  for (auto& v : u)
    v[1] += 5e-3;
  const auto solver_ = solver(model);
  solver_->set_displacements(u);
  Vectors f;
  solver_->internal_forces(f);
  // Errors are measured relative to the forces at a stretch of 1 %.
  solver_->set_displacements(affine(model, { { { { 1.01, 0, 0 } }, { { 0, 1, 0 } }, { { 0, 0, 1 } } } }));
  Vectors scale;
  solver_->internal_forces(scale);
  EXPECT_LT(test::largest(f), test::largest(scale) * (single_precision() ? 1e-2 : 1e-9));
}

TEST_P(Forces, AffinePatchHasNoForceInside)
{
  const Model model = test::block_model();
  const auto solver_ = solver(model);
  solver_->set_displacements(affine(model, { { { { 1.2, 0.1, 0 } }, { { -0.05, 0.9, 0.2 } }, { { 0.1, 0, 1.1 } } } }));
  Vectors f;
  solver_->internal_forces(f);
  double inside = 0;
  for (std::size_t n = 0; n < f.size(); ++n)
  {
    bool interior = true;
    for (int axis = 0; axis < 3; ++axis)
      interior = interior && model.nodes[n][axis] > 0 && model.nodes[n][axis] < model.size[axis];
    if (interior)
      for (const double c : f[n])
        inside = std::max(inside, std::abs(c));
  }
  EXPECT_LT(inside, test::largest(f) * (single_precision() ? 2e-5 : 1e-12));
}

class EnergyGradient : public testing::TestWithParam<std::tuple<Backend, HourglassControl>>
{
};

TEST_P(EnergyGradient, IsTheForce)
{
  test::BlockSettings s = ragged();
  s.voxels = { { 3, 2, 2 } };
  s.keep = [](int i, int j, int k) { return !(i == 1 && j == 1 && k == 1); };
  Model model = test::block_model(s);
  model.hourglass = std::get<1>(GetParam());
  const auto solver_ = make_solver(std::make_shared<const Model>(model), { std::get<0>(GetParam()), 0, 0 });
  test::expect_forces_from_energy(model, *solver_, test::random_vectors(model, 2e-4));
}

INSTANTIATE_TEST_SUITE_P(Backends, EnergyGradient,
                         testing::Combine(testing::ValuesIn(available_backends()),
                                          testing::Values(HourglassControl::scalar, HourglassControl::assumed_strain)));

TEST_P(Forces, AgreeWithTheReferenceAtLargeDeformationWithFibres)
{
  Model model = test::block_model(ragged());
  Muscle muscle;
  muscle.name = "m";
  muscle.passive = true;
  test::add_muscle(model, { { 0.6f, 0.0f, 0.8f } }, muscle);
  const Vectors u = test::random_vectors(model, 3e-4);
  const auto reference = make_solver(std::make_shared<const Model>(model), { "reference", 0, 0 });
  const auto solver_ = solver(model);
  Vectors expected, found;
  for (auto* s : { reference.get(), solver_.get() })
  {
    Controls controls{ { 0.7f }, {} };
    s->advance(1e-9, controls);  // a tiny step applies the activation
    s->set_displacements(u);
  }
  reference->internal_forces(expected);
  solver_->internal_forces(found);
  double difference = 0;
  for (std::size_t n = 0; n < expected.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      difference = std::max(difference, std::abs(expected[n][axis] - found[n][axis]));
  EXPECT_LT(difference, test::largest(expected) * 2e-6);
}

FRONTALIS_EVERY_BACKEND(Forces);
