#include "solver/stepping/assembled_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

constexpr double bound = 4e10;        // of the squared frequency at nodes at rest [1/s2]
constexpr double soft = 0.1 * bound;  // squared frequency of the assembled model at rest [1/s2]

struct Search
{
  double found = soft;
  int searches = 0;
  float activation = -1;  // of the latest search
  bool moving = false;

  AssembledEstimate::Renewal renew(AssembledEstimate& estimate, float present, double measured = 0)
  {
    return estimate.renew({ present }, moving, measured, bound,
                          [this](const std::vector<float>& at)
                          {
                            ++searches;
                            activation = at[0];
                            return found;
                          });
  }
  // The number of steps until the next search, in plans of 10 steps.
  int steps_until_next(AssembledEstimate& estimate, float present, double measured = 0)
  {
    const int before = searches;
    int steps = 0;
    for (; searches == before && steps < 10000; steps += searches == before ? 10 : 0)
    {
      estimate.steps_taken(10, estimate.covered(measured));
      renew(estimate, present, measured);
    }
    return steps + 10;
  }
};

}  // namespace

TEST(AssembledEstimate, is_found_rarely_once_the_model_is_steady)
{
  AssembledEstimate estimate;
  Search search;
  EXPECT_FALSE(estimate.known());
  search.renew(estimate, 0);
  EXPECT_EQ(search.searches, 1);
  EXPECT_EQ(search.activation, 0);
  EXPECT_DOUBLE_EQ(estimate.covered(0), 1.25 * soft) << "a wide margin at first";
  EXPECT_TRUE(estimate.in_motion());
  for (const int steps : { 300, 2000, 2000 })
  {
    EXPECT_EQ(search.steps_until_next(estimate, 0), steps);
    EXPECT_DOUBLE_EQ(estimate.covered(0), 1.1 * soft);
    EXPECT_FALSE(estimate.in_motion());
  }
}

TEST(AssembledEstimate, is_found_ever_more_rarely_while_the_model_changes)
{
  for (const bool vibrates : { false, true })
  {
    AssembledEstimate estimate;
    Search search;
    search.renew(estimate, 0);
    for (const int steps : { 300, 600, 1200 })
    {
      EXPECT_DOUBLE_EQ(estimate.covered(0), 1.25 * search.found);
      EXPECT_TRUE(estimate.in_motion());
      if (!vibrates)
        search.found *= 1.04;
      EXPECT_EQ(search.steps_until_next(estimate, 0, vibrates ? 1.172 * soft : 0), steps);
    }
    EXPECT_FALSE(estimate.in_motion());
    EXPECT_DOUBLE_EQ(estimate.covered(0), 1.1 * search.found);
  }
}

TEST(AssembledEstimate, grows_by_no_more_than_the_stiffness_of_voxels)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  EXPECT_DOUBLE_EQ(estimate.covered(1.1 * soft), 1.25 * soft) << "the margin covers a little growth";
  EXPECT_DOUBLE_EQ(estimate.covered(1.5 * soft), 1.1 * 1.5 * soft) << "a search finds too low a frequency";
  // A search finds that the model has not stiffened.
  search.steps_until_next(estimate, 0, 1.5 * soft);
  EXPECT_DOUBLE_EQ(estimate.covered(0.5 * soft), 1.25 * soft) << "it does not fall between searches";
  EXPECT_DOUBLE_EQ(estimate.latest(), soft);
}

// A step is shorter by 1 - sqrt(1.25 / (1.1 growth)) than the estimate allows.
TEST(AssembledEstimate, is_found_again_when_growth_has_cost_as_many_steps_as_a_search)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  EXPECT_EQ(search.steps_until_next(estimate, 0, 4 * soft), 50)
      << "0.467 of each step is lost; the search follows the plan that exceeds 20";
  EXPECT_EQ(search.steps_until_next(estimate, 0, 1.43 * soft), 190) << "0.109 of each";
  EXPECT_EQ(search.steps_until_next(estimate, 0, 1.15 * soft), 300) << "0.006 of each";
}

TEST(AssembledEstimate, is_confirmed_by_a_search_that_finds_the_same)
{
  const auto after = [](double found, bool moving, float present, double measured)
  {
    AssembledEstimate estimate;
    Search search;
    search.renew(estimate, 0);
    EXPECT_FALSE(search.renew(estimate, 0).searched);
    estimate.steps_taken(300, estimate.covered(measured));
    search.found = found;
    search.moving = moving;
    const auto renewal = search.renew(estimate, present, measured);
    EXPECT_TRUE(renewal.searched);
    return renewal.confirmed;
  };
  EXPECT_TRUE(after(1.02 * soft, false, 0, 0));
  EXPECT_TRUE(after(1.02 * soft, false, 0, 4 * soft)) << "whatever was measured";
  EXPECT_FALSE(after(1.04 * soft, false, 0, 0));
  EXPECT_FALSE(after(soft, true, 0, 0));
  EXPECT_FALSE(after(soft, false, 0.1F, 0));
  EXPECT_FALSE(after(0, false, 0, 0));
}

TEST(AssembledEstimate, remains_that_of_a_steady_model_if_growth_is_not_confirmed)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 300);
  EXPECT_LT(search.steps_until_next(estimate, 0, 1.43 * soft), 300);
  EXPECT_DOUBLE_EQ(estimate.covered(0), 1.1 * soft);
  EXPECT_FALSE(estimate.in_motion());
  search.found = 1.43 * soft;
  EXPECT_LT(search.steps_until_next(estimate, 0, 1.43 * soft), 300);
  EXPECT_DOUBLE_EQ(estimate.covered(0), 1.25 * 1.43 * soft);
  EXPECT_TRUE(estimate.in_motion());
}

TEST(AssembledEstimate, is_found_at_equal_times_while_steps_are_long)
{
  for (const double step : { 1e-3, 3.2e-4, 1e-4, 1e-5 })
  {
    AssembledEstimate estimate;
    Search search;
    search.found = std::min(bound, 4 / (step * step));
    search.renew(estimate, 0);
    const int steps = search.steps_until_next(estimate, 0);
    EXPECT_EQ(steps, step > 4e-4 ? 80 : step > 2e-4 ? 100 : 300) << step;
  }
}

TEST(AssembledEstimate, falls_slowly_and_is_found_often_meanwhile)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  double before = estimate.covered(0);
  search.found = 0.2 * soft;  // in a moment in which the tissue is soft
  for (int i = 0; i < 4; ++i)
  {
    search.found *= 0.9;
    EXPECT_EQ(search.steps_until_next(estimate, 0), 300);
    EXPECT_DOUBLE_EQ(estimate.covered(0), 0.7 * before);
    before *= 0.7;
  }
  EXPECT_DOUBLE_EQ(estimate.softest(), before);
  search.found = 0.3 * bound;
  search.steps_until_next(estimate, 0);
  EXPECT_DOUBLE_EQ(estimate.covered(0), 1.25 * 0.3 * bound) << "it rises at once";
  EXPECT_DOUBLE_EQ(estimate.softest(), before);
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
  EXPECT_EQ(search.steps_until_next(estimate, 0.95F), 300) << "what muscles pull stiffens later";
  EXPECT_FLOAT_EQ(search.activation, 0.97F);
}

TEST(AssembledEstimate, looks_as_far_ahead_as_before_when_tissue_has_stiffened)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  search.renew(estimate, 0.3F);
  EXPECT_EQ(search.steps_until_next(estimate, 0.4F, 1.5 * soft), 160);
  EXPECT_EQ(search.searches, 3);
  EXPECT_FLOAT_EQ(search.activation, 0.8F);
  search.renew(estimate, 0.7F, soft);
  EXPECT_EQ(search.searches, 3) << "the activations of the search before still cover these";
}

TEST(AssembledEstimate, forgets_activations_when_discarded)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0.3F);
  estimate.steps_taken(150, soft);
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
  EXPECT_EQ(search.steps_until_next(estimate, 0), 300);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 300);
  search.moving = false;
  EXPECT_EQ(search.steps_until_next(estimate, 0), 300);
  EXPECT_EQ(search.steps_until_next(estimate, 0), 2000);
}

TEST(AssembledEstimate, takes_no_bad_number)
{
  AssembledEstimate estimate;
  Search search;
  search.renew(estimate, 0);
  for (const double bad : { std::nan(""), 0.0 })
  {
    search.found = bad;
    search.steps_until_next(estimate, 0);
    EXPECT_EQ(estimate.covered(0), bound);
  }
  EXPECT_DOUBLE_EQ(estimate.covered(1.5 * bound), 1.1 * 1.5 * bound) << "what is measured may exceed the bound at rest";
  search.found = soft;
  for (int i = 0; i < 20; ++i)
    search.steps_until_next(estimate, 0);
  EXPECT_LT(estimate.covered(0), bound);
  estimate.discard();
  EXPECT_FALSE(estimate.known());
  const int before = search.searches;
  search.renew(estimate, 0);
  EXPECT_EQ(search.searches, before + 1);
}
