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
  int searches = 0;
  float activation = -1;  // of the latest search
  bool moving = false;

  void renew(AssembledEstimate& estimate, float present, double bound = rest)
  {
    estimate.renew({ present }, moving, bound,
                   [this](const std::vector<float>& at)
                   {
                     ++searches;
                     activation = at[0];
                     return found;
                   });
  }
  // The number of steps until the next search, in plans of 10 steps.
  int steps_until_next(AssembledEstimate& estimate, float present, double bound = rest)
  {
    const int before = searches;
    int steps = 0;
    for (; searches == before && steps < 10000; steps += searches == before ? 10 : 0)
    {
      estimate.steps_taken(10);
      renew(estimate, present, bound);
    }
    return steps + 10;
  }
};

}  // namespace

TEST(AssembledEstimate, is_found_at_first_and_then_ever_more_rarely)
{
  AssembledEstimate estimate;
  Search search;
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  search.renew(estimate, 0);
  EXPECT_EQ(search.searches, 1);
  EXPECT_EQ(search.activation, 0);
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(rest), 1.25 * 0.5 * rest) << "a wide margin at first";
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(0.8 * rest), 1.25 * 0.5 * rest) << "it does not fall with the bound";
  EXPECT_DOUBLE_EQ(estimate.bound_covered(0.8 * rest), rest);
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(2 * rest), 1.25 * rest) << "it grows with it";
  for (const int steps : { 200, 400, 800, 1600, 2000, 2000 })
    EXPECT_EQ(search.steps_until_next(estimate, 0), steps);
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(rest), 1.1 * 0.5 * rest);
}

TEST(AssembledEstimate, is_found_again_where_the_bound_has_grown)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  EXPECT_EQ(search.steps_until_next(estimate, 0, 1.11 * rest), 100) << "but not at once";
  EXPECT_EQ(search.steps_until_next(estimate, 0, 1.2 * rest), 200);
}

TEST(AssembledEstimate, falls_slowly_and_is_found_often_meanwhile)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  double before = estimate.frequency_squared(rest);
  // The search meets tissue in a soft moment, in which its bound is low, too.
  search.found = 0.1 * rest;
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_EQ(search.steps_until_next(estimate, 0, 0.8 * rest), 200);
    EXPECT_DOUBLE_EQ(estimate.frequency_squared(0.8 * rest), 0.7 * before);
    before *= 0.7;
  }
  search.found = 0.3 * rest;
  search.steps_until_next(estimate, 0, 0.8 * rest);
  EXPECT_DOUBLE_EQ(estimate.frequency_squared(0.8 * rest), 1.25 * 0.3 * rest) << "it rises at once";
}

TEST(AssembledEstimate, looks_ahead_while_activations_grow)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  search.renew(estimate, 0.3F);
  EXPECT_EQ(search.searches, 2) << "at once";
  EXPECT_FLOAT_EQ(search.activation, 0.8F);
  search.renew(estimate, 0.79F);
  search.renew(estimate, 0.1F);
  EXPECT_EQ(search.searches, 2);
  search.renew(estimate, 0.95F);
  EXPECT_EQ(search.searches, 3);
  EXPECT_EQ(search.activation, 1);
  EXPECT_EQ(search.steps_until_next(estimate, 0.95F), 200) << "what muscles pull stiffens later";
  EXPECT_FLOAT_EQ(search.activation, 0.97F);
  EXPECT_DOUBLE_EQ(estimate.share(), 1.25 * 0.5);
}

TEST(AssembledEstimate, looks_as_far_ahead_as_before_when_tissue_has_stiffened)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  search.renew(estimate, 0.3F);
  EXPECT_EQ(search.steps_until_next(estimate, 0.4F, 1.2 * rest), 100);
  EXPECT_EQ(search.searches, 3);
  EXPECT_FLOAT_EQ(search.activation, 0.8F);
  search.renew(estimate, 0.7F, 1.2 * rest);
  EXPECT_EQ(search.searches, 3) << "the activations of the search before still cover these";
}

TEST(AssembledEstimate, forgets_activations_when_discarded)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0.3F);
  estimate.steps_taken(150);
  estimate.discard();
  search.renew(estimate, 0.1F);
  EXPECT_FLOAT_EQ(search.activation, 0.12F);
}

TEST(AssembledEstimate, is_found_often_while_bones_move)
{
  AssembledEstimate estimate;
  Search search;
  search.moving = true;
  search.renew(estimate, 0);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 200);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 200);
  search.moving = false;
  EXPECT_EQ(search.steps_until_next(estimate, 0), 200);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 400);
}

TEST(AssembledEstimate, is_never_above_the_bound_and_takes_no_bad_number)
{
  AssembledEstimate estimate;
  Search search;
  search.found = 2 * rest;
  search.renew(estimate, 0);
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  for (const double bad : { std::nan(""), 0.0 })
  {
    search.found = bad;
    search.steps_until_next(estimate, 0);
    EXPECT_EQ(estimate.frequency_squared(rest), rest);
  }
  search.found = 0.5 * rest;
  search.steps_until_next(estimate, 0);
  EXPECT_LT(estimate.share(), 1);
  estimate.discard();
  EXPECT_EQ(estimate.frequency_squared(rest), rest);
  const int before = search.searches;
  search.renew(estimate, 0);
  EXPECT_EQ(search.searches, before + 1);
}
