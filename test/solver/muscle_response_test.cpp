#include "solver/stepping/muscle_response.hpp"

#include "block_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

Model model_of_muscle(double rise_time, double fall_time, double slew = 0)
{
  Model model = test::block_model();
  Muscle muscle;
  muscle.rise_time = rise_time;
  muscle.fall_time = fall_time;
  model.muscles = { muscle };
  model.activation_slew = slew;
  return model;
}

double after(const Model& model, double asked_from, double asked_to, double seconds, double from)
{
  std::vector<float> activation{ static_cast<float>(from) };
  respond(model, { static_cast<float>(asked_from) }, { static_cast<float>(asked_to) }, seconds, activation);
  return double(activation[0]);
}

}  // namespace

TEST(MuscleResponse, is_exact_for_activations_that_go_linearly)
{
  for (const bool rises : { true, false })
  {
    const Model model = model_of_muscle(rises ? 0.01 : 1, rises ? 1 : 0.03);
    const double time = rises ? 0.01 : 0.03, from = rises ? 0.1 : 0.9, to = rises ? 0.9 : 0.1;
    const double begin = rises ? 0.05 : 0.95, seconds = 0.02;
    // Forward differences, whose error is proportional to the step.
    constexpr int steps = 100000;
    double a = begin;
    for (int i = 0; i < steps; ++i)
      a += seconds / steps * (from + (i + 0.5) / steps * (to - from) - a) / time;
    EXPECT_NEAR(after(model, from, to, seconds, begin), a, 1e-5);
    // Two half steps give the same result.
    const double half = after(model, from, 0.5 * (from + to), seconds / 2, begin);
    EXPECT_NEAR(after(model, 0.5 * (from + to), to, seconds / 2, half), a, 1e-5);
  }
}

TEST(MuscleResponse, comes_to_what_is_asked_for)
{
  const Model model = model_of_muscle(0.01, 0.03);
  EXPECT_NEAR(after(model, 0.7, 0.7, 1, 0), 0.7, 1e-6);
  EXPECT_NEAR(after(model, 0.2, 0.2, 1, 1), 0.2, 1e-6);
  EXPECT_NEAR(after(model, 1, 1, 0.01, 0), 1 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(after(model, 0, 0, 0.03, 1), std::exp(-1.0), 1e-6);
  EXPECT_FLOAT_EQ(static_cast<float>(after(model_of_muscle(0, 0), 0, 0.6, 1e-6, 0)), 0.6f) << "at once without times";
}

TEST(MuscleResponse, is_no_faster_than_the_slew_limit)
{
  const Model model = model_of_muscle(0, 0, 10);
  EXPECT_NEAR(after(model, 0, 1, 0.02, 0), 0.2, 1e-6);
  EXPECT_NEAR(after(model, 1, 0, 0.02, 1), 0.8, 1e-6);
  EXPECT_NEAR(after(model, 0.1, 0.15, 0.02, 0), 0.15, 1e-6);
}
