// changes of a model at rest: creases that stay in shells, a skin that is in place once the tissue is in equilibrium

#include "backends.hpp"
#include "shell_model.hpp"

#include "frontalis/solver/rest_shape.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

using namespace test;
using Vectors = std::vector<std::array<double, 3>>;

class RestShape : public EveryBackend
{
};

Model film_on_block()
{
  BlockSettings settings;
  settings.voxels = { { 10, 6, 4 } };
  Model model = block_model(settings);
  hold_plane(model, 2);
  add_shell(model);
  return model;
}

// a wave that folds the film and does not stretch it much, times a factor
Vectors wave(const Model& model, double factor)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n][2] = factor * 5e-6 * std::sin(2 * 3.14159265 * rest(model, n)[0] / 10e-3);
  return u;
}

// The shape at `set` times the fold has no bending moment, so that the energy grows with the square of the distance
// from this shape.
TEST_P(RestShape, the_part_of_a_fold_that_stays_has_no_moment)
{
  const Model smooth = film_on_block();
  constexpr double set = 0.4;
  Model creased = smooth;
  add_creases(creased, wave(smooth, 1), set);
  const auto energy = [&](const Model& model, double factor)
  {
    SolverSettings settings{ GetParam(), 1, 0 };
    settings.ledger = true;
    const auto solver = make_solver(std::make_shared<const Model>(model), settings);
    solver->set_displacements(wave(model, factor));
    return solver->ledger()["shell"];
  };
  const double folded = energy(smooth, 1);
  ASSERT_GT(folded, 0);
  for (const double factor : { 0.0, 0.4, 1.0 })
    EXPECT_NEAR(energy(creased, factor) / folded, std::pow(factor - set, 2), 0.02) << factor;
}

// A plate lies on an elastic layer whose lower side is held. The plate resists a wave with the stiffness D k^4, the
// layer with the stiffness q (doc/wrinkles.md). In equilibrium the height of a crease is thus D k^4 / (D k^4 + q) times
// its height in the shape without bending moments.
TEST_P(RestShape, a_crease_comes_up_as_far_as_the_tissue_yields)
{
  Model smooth = film_on_block();
  constexpr double softer = 1e-3, set = 0.5, k = 2 * 3.14159265 / 10e-3, height = 4e-3;
  for (double* const modulus : { &smooth.materials[0].parameters[0], &smooth.materials[0].parameters[1] })
    *modulus *= softer;
  Model creased = smooth;
  add_creases(creased, wave(smooth, 1), set);
  Vectors u;
  const auto still = solver(smooth, 1), face = solver(creased, 1);
  still->advance(1e-4, still->controls());
  still->displacements(u);
  for (const auto& node : u)
    for (const double component : node)
      EXPECT_NEAR(component, 0, 1e-3 * set * 5e-6);
  EXPECT_TRUE(face->settle(face->controls(), 1e-2, 5).reached);
  face->displacements(u);
  double largest = 0;
  for (const auto& node : u)
    largest = std::max(largest, node[2]);
  const ShellSettings film;
  const double plate = film.young * std::pow(film.thickness, 3) / (12 * (1 - film.poisson * film.poisson));
  const double bent = plate * std::pow(k, 4), x = k * height;
  const double layer = 2 * smooth.materials[0].parameters[0] * k * (std::sinh(x) * std::cosh(x) + x) /
                       (std::sinh(x) * std::sinh(x) - x * x);
  EXPECT_NEAR(largest / (set * 5e-6), bent / (bent + layer), 0.3 * bent / (bent + layer));
}

TEST_P(RestShape, the_skin_is_in_place_when_the_tissue_is_in_equilibrium)
{
  Model model = film_on_block();
  model.gravity = { { 1, 0, -9.81 } };
  model.skin = model.shells[0].surface;
  model.skin_binding = model.shells[0].binding;
  model.landmarks = { "middle" };
  model.landmark_positions = { model.skin.vertices[20] };
  model.landmark_binding = { { model.skin_binding.voxel[20] }, { model.skin_binding.coordinates[20] } };
  Model placed = model;
  double before = 0;
  for (const bool corrected : { false, true })
  {
    const auto face = solver(corrected ? placed : model, 1);
    ASSERT_TRUE(face->settle(face->controls(), 1e-4, 1).reached);
    SkinState skin;
    face->skin(skin);
    double away = 0;
    for (std::size_t v = 0; v < skin.vertices.size(); ++v)
      for (std::size_t axis = 0; axis < 3; ++axis)
        away = std::max(away, std::abs(double(skin.vertices[v][axis]) - model.skin.vertices[v][axis]));
    if (!corrected)
    {
      before = away;
      Vectors u;
      face->displacements(u);
      place_skin_at(placed, u);
      continue;
    }
    EXPECT_LT(away, 0.01 * before);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(skin.landmarks[0][axis], model.landmark_positions[0][axis], 0.01 * before);
  }
  EXPECT_GT(before, 1e-6);
}

FRONTALIS_EVERY_BACKEND(RestShape);

}  // namespace
}  // namespace frontalis
