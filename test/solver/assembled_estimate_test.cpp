#include "solver/stepping/assembled_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

constexpr double rest = 4e10;  // bound of the squared frequency at nodes [1/s2]

struct Search
{
  double found = 0.5 * rest;
  int searches = 0, iterations = 0;

  void renew(AssembledEstimate& estimate, float activation, double bound = rest)
  {
    estimate.renew({ activation }, { activation }, bound,
                   [this](int most_iterations)
                   {
                     ++searches;
                     iterations = most_iterations;
                     return found;
                   });
  }
};

}  // namespace

TEST(AssembledEstimate, is_found_at_first_and_then_every_2000_steps)
{
  AssembledEstimate estimate;
  Search search;
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  search.renew(estimate, 0);
  EXPECT_EQ(search.iterations, 300);
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(rest), 1.25 * 0.5 * rest) << "a wide margin at first";
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(0.8 * rest), 1.25 * 0.5 * rest) << "it does not fall with the bound";
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(2 * rest), 1.25 * rest) << "it grows with it";
  for (int steps = 0; steps < 2000; steps += 100)
  {
    search.renew(estimate, 0);
    EXPECT_EQ(search.searches, 1);
    estimate.steps_taken(100);
  }
  search.renew(estimate, 0);
  EXPECT_EQ(search.searches, 2);
  EXPECT_EQ(search.iterations, 16) << "from the mode of the first search";
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(rest), 1.05 * 0.5 * rest);
}

TEST(AssembledEstimate, is_found_again_where_the_bound_has_grown)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  search.renew(estimate, 0, 1.019 * rest);
  EXPECT_EQ(search.searches, 1);
  search.renew(estimate, 0, 1.021 * rest);
  EXPECT_EQ(search.searches, 2);
}

TEST(AssembledEstimate, waits_after_activations_changed)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  search.renew(estimate, 0.09f);
  EXPECT_LT(estimate.share(), 1);
  search.renew(estimate, 0.5f);
  EXPECT_EQ(estimate.share(), 1) << "until what fibres draw has stiffened";
  estimate.steps_taken(199);
  search.renew(estimate, 0.5f, 3 * rest);
  EXPECT_EQ(search.searches, 1);
  for (const int steps : { 1, 400, 800 })
  {
    const int before = search.searches;
    estimate.steps_taken(steps - 1);
    search.renew(estimate, 0.5f);
    EXPECT_EQ(search.searches, before) << steps;
    estimate.steps_taken(1);
    search.renew(estimate, 0.5f);
    EXPECT_EQ(search.searches, before + 1) << steps;
    EXPECT_DOUBLE_EQ(estimate.share(), 1.25 * 0.5) << "a wide margin soon after";
  }
}

TEST(AssembledEstimate, is_never_above_the_bound_and_takes_no_bad_number)
{
  AssembledEstimate estimate;
  Search search;
  search.found = 2 * rest;
  search.renew(estimate, 0);
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  search.found = std::nan("");
  estimate.steps_taken(5000);
  search.renew(estimate, 0);
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  search.found = 0.5 * rest;
  estimate.steps_taken(5000);
  search.renew(estimate, 0);
  EXPECT_LT(estimate.share(), 1);
  estimate.discard();
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  search.renew(estimate, 0);
  EXPECT_EQ(search.iterations, 300);
}
