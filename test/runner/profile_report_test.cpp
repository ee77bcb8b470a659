#include "frontalis/runner/profile_report.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

Model measured()
{
  Model model;
  model.profiles = { { "draft", 0.6e-3, 0.5, "a bench" },
                     { "standard", 0.3e-3, 2, "a bench" },
                     { "fine", 0.1e-3, 20, "a bench" },
                     { "odd", 0, 0, "" } };
  model.profile = "standard";
  return model;
}

TEST(ProfileReport, says_what_was_measured)
{
  Model model = measured();
  EXPECT_EQ(measured_profile(model),
            "accuracy profile 'standard': its skin was measured to be off by 0.3 mm RMS, and a "
            "simulated second to take 2 s on a bench");
  model.profile = "odd";
  EXPECT_EQ(measured_profile(model), "");
  EXPECT_EQ(speed_report(model, 0.5), "runs at 0.5 of real time here");
}

TEST(ProfileReport, names_the_most_accurate_profile_that_would_run_in_real_time)
{
  Model model = measured();
  EXPECT_EQ(speed_report(model, 1), "runs at 1 of real time here");
  // as fast as the machine of the measurement: 2 s for the second
  EXPECT_NE(
      speed_report(model, 0.5).find("profile 'draft' would do: about 0.5 s a simulated second, its skin off by 0.6"),
      std::string::npos)
      << speed_report(model, 0.5);
  model.profile = "fine";
  // forty times as fast
  EXPECT_NE(speed_report(model, 0.8).find("profile 'standard' would do: about 0.12 s"), std::string::npos)
      << speed_report(model, 0.8);
}

TEST(ProfileReport, says_where_none_would_do)
{
  Model model = measured();
  EXPECT_NE(
      speed_report(model, 0.1).find("no profile of the scene would do; the cheapest, 'draft', would run at about 0.4"),
      std::string::npos)
      << speed_report(model, 0.1);
  model.profile = "draft";
  EXPECT_NE(speed_report(model, 0.1).find("no profile of the scene would do: this is the cheapest"), std::string::npos);
}

}  // namespace
}  // namespace frontalis
