#include "solver/stepping/highest_frequency_search.hpp"

#include "block_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

using namespace frontalis;

namespace
{

constexpr double stiffness = 50;  // [N/m]

Model bar()
{
  test::BlockSettings settings;
  settings.voxels = { { 4, 1, 1 } };
  return test::block_model(settings);
}

// A bar of voxels whose nodes form a chain of springs in the order of their numbers.
struct Chain
{
  using Components = HighestFrequencySearch<double>::Components;
  Model model;
  Discretisation discretisation;
  Components u;
  int products = 0;
  double stiff = 1;      // factor on the stiffness of the middle spring
  double curvature = 0;  // relative change of the springs' stiffness per displacement [1/m]
  double mass = 1e-6;

  explicit Chain(Model of = bar()) : model(std::move(of)), discretisation(model)
  {
    for (double& m : discretisation.node_mass)
      m = mass;
    discretisation.held = { 0, nodes() - 1 };
  }
  std::int32_t nodes() const { return static_cast<std::int32_t>(model.nodes.size()); }
  std::vector<FoundMode> modes;  // above half of what the latest search found
  double search()
  {
    products = -1;  // so that evaluating the forces at u does not count as a product
    const std::int32_t count = nodes();
    Components found;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      u[axis].assign(count, 0);
      found[axis].assign(count, 0);
    }
    const auto find = [&](const Components& at)
    {
      ++products;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        std::fill(found[axis].begin(), found[axis].end(), 0.0);
        for (std::int32_t n = 1; n < count; ++n)
        {
          const double stretch = at[axis][n] - at[axis][n - 1];
          const double k = n == count / 2 ? stiff * stiffness : stiffness;
          const double force = k * stretch * (1 + curvature * stretch);
          found[axis][n] += force;
          found[axis][n - 1] -= force;
        }
      }
    };
    HighestFrequencySearch<double> search(model, discretisation, { 0, count / 3, count }, count);
    const double squared = search.run(0, count, u, { find, found, [] {} });
    modes = search.modes_above(0.5 * squared);
    return squared;
  }
  // Exact largest eigenvalue of a chain that is held at both ends.
  double exact() const
  {
    const double segments = nodes() - 1.0;
    return 4 * stiffness / mass * std::pow(std::sin(0.5 * M_PI * (segments - 1) / segments), 2);
  }
};

// Stiffness [N/m] at one node.
class Spring : public AddedStiffness
{
public:
  Spring(const Model& model, std::int32_t node, double of) : stiffness_(of)
  {
    for (std::size_t e = 0; e < model.voxel_nodes.size() && binding_.voxel.empty(); ++e)
      for (int b = 0; b < 8; ++b)
        if (model.voxel_nodes[e][b] == node)
        {
          binding_.voxel = { static_cast<std::int32_t>(e) };
          binding_.coordinates = { { { float(b & 1), float(b >> 1 & 1), float(b >> 2 & 1) } } };
        }
  }
  double in_voxel(std::size_t) const override { return 0; }
  std::vector<PointStiffness> matrices() const override { return { { &binding_, { { 0, 0, stiffness_ } } } }; }

private:
  double stiffness_;
  Binding binding_;
};

}  // namespace

TEST(HighestFrequencySearch, finds_that_of_a_chain)
{
  Chain chain;
  EXPECT_NEAR(chain.search() / chain.exact(), 1, 5e-3);
  EXPECT_LE(chain.search() / chain.exact(), 1 + 1e-6) << "it comes from below";
  EXPECT_LE(chain.products, most_lanczos_iterations);
}

// The vibration of two masses at a spring that is stiffer by a factor r than the others of a long chain has the squared
// frequency 4 r^2 / (2 r - 1) k / m: its amplitude falls by 1 / (2 r - 1) from node to node.
TEST(HighestFrequencySearch, finds_one_stiff_spring)
{
  Chain chain;
  chain.stiff = 3;
  EXPECT_NEAR(chain.search() / (7.2 * stiffness / chain.mass), 1, 5e-3);
}

// A spring from one mass of a long chain to the ground, K, gives the squared frequency (2 k + sqrt(4 k^2 + K^2)) / m:
// the amplitude falls by exp(-s) from node to node, 2 sinh s = K / k.
TEST(HighestFrequencySearch, finds_the_stiffness_that_an_effect_adds_at_a_node)
{
  Chain chain;
  chain.discretisation.added = { std::make_shared<Spring>(chain.model, chain.nodes() / 2, 5 * stiffness) };
  EXPECT_NEAR(chain.search() / ((2 + std::sqrt(29.0)) * stiffness / chain.mass), 1, 5e-3);
}

TEST(HighestFrequencySearch, adds_stiffness_at_a_joint_to_both_nodes)
{
  Model model = bar();
  const auto middle = static_cast<std::int32_t>(model.nodes.size() / 2);
  model.joints.push_back({ middle, middle - 1 });
  Chain chain(model);
  for (std::int32_t n = 0; n < chain.nodes(); ++n)
    if (n < middle - 1 || n > middle)
      chain.discretisation.held.push_back(n);
  // Springs of stiffness k on both sides of the two masses, and one at each of them:
  chain.discretisation.added = { std::make_shared<Spring>(chain.model, middle, 3 * stiffness),
                                 std::make_shared<Spring>(chain.model, middle - 1, 4 * stiffness) };
  EXPECT_NEAR(chain.search() / (9 * stiffness / (2 * chain.mass)), 1, 5e-3);
}

TEST(HighestFrequencySearch, is_little_disturbed_by_the_curvature_of_laws)
{
  Chain straight, curved;
  // Over the displacement of a product the stiffness changes by several percent, more than that of tissue does.
  curved.curvature = 0.03 / mode_amplitude(curved.model, 0);
  EXPECT_NEAR(curved.search() / straight.search(), 1, 0.03);
  EXPECT_EQ(mode_amplitude(curved.model, 1), -mode_amplitude(curved.model, 0));
}

TEST(HighestFrequencySearch, ends_at_numbers_that_are_not_finite)
{
  Chain chain;
  chain.curvature = std::nan("");
  EXPECT_FALSE(std::isfinite(chain.search()));
  EXPECT_EQ(chain.products, 1);
  chain.curvature = 0;
  EXPECT_NEAR(chain.search() / chain.exact(), 1, 5e-3) << "nothing is left of it";
}

// Two masses at the ends of a spring that a joint bridges move as one, between two springs.
TEST(HighestFrequencySearch, moves_both_nodes_of_a_joint_as_one)
{
  Model model = bar();
  const auto middle = static_cast<std::int32_t>(model.nodes.size() / 2);
  model.joints.push_back({ middle, middle - 1 });
  Chain chain(model);
  chain.stiff = 100;
  for (std::int32_t n = 0; n < chain.nodes(); ++n)
    if (n < middle - 1 || n > middle)
      chain.discretisation.held.push_back(n);
  EXPECT_NEAR(chain.search() / (stiffness / chain.mass), 1, 5e-3);
}

// The two masses at a stiff spring move against each other, and the others move less from node to node.
TEST(HighestFrequencySearch, tells_which_nodes_move_in_the_mode)
{
  Chain chain;
  chain.model.mass_scaling.in_motion = 1e-4;
  chain.stiff = 10;
  const double squared = chain.search();
  ASSERT_FALSE(chain.modes.empty());
  const FoundMode& mode = chain.modes.front();
  EXPECT_NEAR(mode.frequency_squared, squared, 1e-5 * squared);
  ASSERT_GE(mode.shares.size(), 2u);
  double at_spring = 0;
  for (const ModeShare& of : mode.shares)
    at_spring += of.node == chain.nodes() / 2 || of.node == chain.nodes() / 2 - 1 ? double(of.share) : 0;
  EXPECT_NEAR(at_spring, 1 - 1.0 / (19 * 19), 2e-3);
}

TEST(HighestFrequencySearch, finds_nothing_where_no_node_can_move)
{
  Chain chain;
  for (std::int32_t n = 0; n < chain.nodes(); ++n)
    chain.discretisation.held.push_back(n);
  EXPECT_TRUE(std::isnan(chain.search()));
}

TEST(LanczosMatrix, has_the_largest_eigenvalue_of_its_rows)
{
  LanczosMatrix matrix;
  EXPECT_TRUE(std::isnan(matrix.largest_eigenvalue()));
  EXPECT_FALSE(matrix.settled());
  matrix.add_row(2, 1);
  EXPECT_DOUBLE_EQ(matrix.largest_eigenvalue(), 2);
  // eigenvalues of (2 1; 1 2) and of the same with a third row are 3 and 2 + sqrt(2)
  matrix.add_row(2, 1);
  EXPECT_NEAR(matrix.largest_eigenvalue(), 3, 1e-5);
  matrix.add_row(2, 1);
  EXPECT_NEAR(matrix.largest_eigenvalue(), 2 + std::sqrt(2.0), 1e-5);
  EXPECT_FALSE(matrix.settled());
  matrix.add_row(2, 1e-9);
  EXPECT_TRUE(matrix.settled()) << "nothing is left beside the diagonal";
  matrix.add_row(std::nan(""), 1);
  EXPECT_TRUE(std::isnan(matrix.largest_eigenvalue()));
  EXPECT_TRUE(matrix.settled());
}

TEST(LanczosMatrix, has_the_eigenvectors_of_its_rows)
{
  LanczosMatrix matrix;
  matrix.add_row(2, 1);
  matrix.add_row(2, 1);
  const auto pairs = matrix.eigenpairs_above(0);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_NEAR(pairs[0].value, 3, 1e-12);
  EXPECT_NEAR(pairs[0].vector[0] * pairs[0].vector[1], 0.5, 1e-12);
  EXPECT_NEAR(pairs[1].value, 1, 1e-12);
  EXPECT_EQ(matrix.eigenpairs_above(2).size(), 1u);
  matrix.add_row(std::nan(""), 1);
  EXPECT_TRUE(matrix.eigenpairs_above(0).empty());
}

TEST(LanczosMatrix, settles_after_eight_rows_that_change_nothing)
{
  LanczosMatrix matrix;
  for (int row = 0; row < 8; ++row)
  {
    EXPECT_FALSE(matrix.settled()) << row;
    matrix.add_row(row < 5 ? 1 : 0.1, 0.01);
  }
  EXPECT_TRUE(matrix.settled());
}
