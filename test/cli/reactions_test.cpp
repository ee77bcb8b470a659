// `frontalis run` reports the force and moment on a body that tissue touches.

#include "cli/bar_model.hpp"
#include "cli/program.hpp"

#include "frontalis/model/model_file.hpp"
#include "frontalis/model/sample_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

TEST(Reactions, are_printed_and_written_in_the_face_frame)
{
  const TemporaryFolder folder;
  Model model = bar_model();
  model.bones = { "finger" };
  Contact contact;
  contact.name = "touch";
  contact.bone = 0;
  // a plane 0.2 mm beyond the free end
  contact.field = sphere_field({ { 16.2e-3 + 1000, 0, 0 } }, 1000);
  set_points(contact, model.skin, model.skin_binding);
  model.contacts = { contact };
  write_model(model, folder / "bar.vtkhdf");
  const ProgramResult result =
      run_program({ "run", folder / "bar.vtkhdf", "--backend", "cpu", "--bone", "finger=0,0,-0.7,0,0,0", "--ramp",
                    "0.1", "--seconds", "0.4", "--frames", folder / "frames", "--ledger" });
  EXPECT_EQ(result.code, 0) << result.errors;
  expect_contains(result.output, "reaction           touch: ");
  expect_contains(result.output, "energy             contact        +");
  const nlohmann::json json = json_from(text_of(folder / "frames" + "/run.json"));
  const auto force = json["reactions"]["touch"]["force_N"], moment = json["reactions"]["touch"]["moment_Nm"];
  // below E A strain = 15 mN, the force for a strain of 0.5 / 16, because only the corners of the end touch
  const double up = force[2];
  EXPECT_GT(up, 0.007);
  EXPECT_LT(up, 0.015);
  EXPECT_NEAR(force[0], 0, 0.01 * up);
  // the force acts in the middle of the end, (502, 252) mm from the origin of the face frame
  EXPECT_NEAR(moment[0], 0.252 * up, 0.01 * up);
  EXPECT_NEAR(moment[1], -0.502 * up, 0.01 * up);
  EXPECT_NEAR(moment[2], 0, 0.01 * up);
  const std::string table = text_of(folder / "frames" + "/reactions.csv");
  expect_contains(table, "frame,time_s,body,force_x_N,");
  expect_contains(table, "\n0,0.000000,touch,0,0,0,0,0,0\n");
  expect_contains(table, "\n20,0.400000,touch,");
}

}  // namespace
}  // namespace frontalis
