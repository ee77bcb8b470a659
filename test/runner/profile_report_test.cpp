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
  EXPECT_EQ(
      measured_profile(model),
      "accuracy profile 'standard': measured skin error 0.3 mm RMS, measured cost 2 s per simulated second on a bench");
  model.profile = "odd";
  EXPECT_EQ(measured_profile(model), "");
  EXPECT_EQ(speed_report(model, 0.5), "real-time factor 0.5");
}

TEST(ProfileReport, names_the_most_accurate_profile_that_would_run_in_real_time)
{
  Model model = measured();
  EXPECT_EQ(speed_report(model, 1), "real-time factor 1");
  // this machine is as fast as the machine of the measurement: 2 s per simulated second
  EXPECT_NE(
      speed_report(model, 0.5)
          .find("profile 'draft' would run in real time: about 0.5 s per simulated second, skin error 0.6 mm RMS"),
      std::string::npos)
      << speed_report(model, 0.5);
  model.profile = "fine";
  // this machine is sixteen times as fast as that of the measurement
  EXPECT_NE(speed_report(model, 0.8).find("profile 'standard' would run in real time: about 0.12 s"), std::string::npos)
      << speed_report(model, 0.8);
}

TEST(ProfileReport, says_where_none_would_do)
{
  Model model = measured();
  EXPECT_NE(
      speed_report(model, 0.1)
          .find(
              "no profile of the scene would run in real time; the cheapest, 'draft', would have a real-time factor of "
              "about 0.4"),
      std::string::npos)
      << speed_report(model, 0.1);
  model.profile = "draft";
  EXPECT_NE(speed_report(model, 0.1).find("would run in real time; this is the cheapest"), std::string::npos);
}

}  // namespace
}  // namespace frontalis
