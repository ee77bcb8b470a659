#include "solver/stepping/highest_frequency_search.hpp"

#include "block_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  Model model;
  Discretisation discretisation;
  NodalVectors u, mode;
  int products = 0;
  double curvature = 0;  // relative change of the springs' stiffness per displacement [1/m]
  double mass = 1e-6;

  Chain() : model(bar()), discretisation(model), u(model.nodes.size())
  {
    for (double& m : discretisation.node_mass)
      m = mass;
    discretisation.held = { 0, static_cast<std::int32_t>(u.size()) - 1 };
  }
  double search(int most_iterations)
  {
    products = -1;  // so that evaluating the forces at u does not count as a product
    return highest_frequency_squared(
        model, discretisation, u,
        [this](const NodalVectors& at, NodalVectors& out)
        {
          ++products;
          out.assign(at.size(), {});
          for (std::size_t n = 1; n < at.size(); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
              const double stretch = at[n][axis] - at[n - 1][axis];
              const double force = stiffness * stretch * (1 + curvature * stretch);
              out[n][axis] += force;
              out[n - 1][axis] -= force;
            }
        },
        most_iterations, mode);
  }
  // Exact largest eigenvalue of a chain that is held at both ends.
  double exact() const
  {
    const double segments = static_cast<double>(u.size()) - 1;
    return 4 * stiffness / mass * std::pow(std::sin(0.5 * M_PI * (segments - 1) / segments), 2);
  }
};

}  // namespace

TEST(HighestFrequencySearch, finds_that_of_a_chain)
{
  Chain chain;
  // 2000 products suppress the other modes.
  EXPECT_NEAR(chain.search(2000) / chain.exact(), 1, 5e-3);
  EXPECT_LE(chain.search(2000) / chain.exact(), 1 + 1e-9) << "it comes from below";
  for (const auto n : chain.discretisation.held)
    for (const double x : chain.mode[n])
      EXPECT_EQ(x, 0) << "held nodes stay";
}

TEST(HighestFrequencySearch, goes_on_from_the_latest_mode)
{
  Chain chain;
  const double first = chain.search(300);
  EXPECT_GT(chain.products, 9);
  const double second = chain.search(16);
  EXPECT_LE(chain.products, 16);
  EXPECT_GE(second, first * (1 - 1e-9));
}

TEST(HighestFrequencySearch, takes_the_curvature_of_laws_out_of_two_products)
{
  Chain straight, curved;
  // The stiffness changes noticeably over the displacement of a product.
  curved.curvature = 0.1 / mode_amplitude(curved.model);
  EXPECT_NEAR(curved.search(300) / straight.search(300), 1, 0.03);
}

TEST(HighestFrequencySearch, begins_anew_after_numbers_that_are_not_finite)
{
  Chain chain;
  chain.curvature = std::nan("");
  EXPECT_FALSE(std::isfinite(chain.search(300)));
  EXPECT_EQ(chain.products, 1);
  EXPECT_TRUE(chain.mode.empty());
  chain.curvature = 0;
  EXPECT_NEAR(chain.search(300) / chain.exact(), 1, 0.05);
}

TEST(LargestEigenvalue, ends_where_it_has_settled)
{
  std::vector<double> steps;
  const auto constant = [&](double step)
  {
    steps.push_back(step);
    return 7.0;
  };
  EXPECT_EQ(largest_eigenvalue(100, 0.5, constant), 7);
  EXPECT_EQ(steps.size(), 9u);
  for (std::size_t i = 0; i < steps.size(); ++i)
    EXPECT_EQ(steps[i], i % 2 == 0 ? 0.5 : -0.5);
  int products = 0;
  const auto growing = [&](double) { return std::pow(1.001, ++products); };
  largest_eigenvalue(40, 1, growing);
  EXPECT_EQ(products, 40);
  // Values alternate with the sign of the step, so that each is compared with the last value of the same sign.
  products = 0;
  EXPECT_EQ(largest_eigenvalue(100, 1, [&](double step) { return ++products, step > 0 ? 5.0 : 3.0; }), 5);
  EXPECT_EQ(products, 9);
}
