// `frontalis run` reports the force and moment on a body that tissue touches.

#include "cli/bar_model.hpp"
#include "cli/program.hpp"

#include "frontalis/model/model_file.hpp"
#include "frontalis/model/sample_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

Model bar_and_finger()
{
  Model model = bar_model();
  model.bones = { "finger" };
  Contact contact;
  contact.name = "touch";
  contact.bone = 0;
  // a plane 0.2 mm beyond the free end
  contact.field = sphere_field({ { 16.2e-3 + 1000, 0, 0 } }, 1000);
  set_points(contact, model.skin, model.skin_binding);
  model.contacts = { contact };
  return model;
}

TEST(Reactions, are_printed_and_written_in_the_face_frame)
{
  const TemporaryFolder folder;
  write_model(bar_and_finger(), folder / "bar.vtkhdf");
  const ProgramResult result =
      run_program({ "run", folder / "bar.vtkhdf", "--backend", "cpu", "--bone", "finger=0,0,-0.7,0,0,0", "--ramp",
                    "0.1", "--seconds", "0.4", "--frames", folder / "frames", "--ledger" });
  EXPECT_EQ(result.code, 0) << result.errors;
  expect_contains(result.output, "reaction           touch: ");
  expect_contains(result.output, "energy             contact        +");
  const nlohmann::json json = json_from(text_of(folder / "frames" + "/run.json"));
  const auto force = json["reactions"]["touch"]["force_N"], moment = json["reactions"]["touch"]["moment_Nm"];
  // a strain of 0.5 / 16 needs the force E A strain = 15 mN; here it is less, because only the corners of the end touch
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

// The same motion is given as a demo, as a table and by options.
TEST(Reactions, come_from_poses_over_time)
{
  const TemporaryFolder folder;
  Model model = bar_and_finger();
  model.demo = { { 0, 0.1, 0.2, { { 0, { { 0, 0, -0.7e-3 } }, { { 0.01, 0, 0 } } } } }, { -2, 0, 0.1 } };
  write_model(model, folder / "bar.vtkhdf");
  folder.write("table.csv", "time,pull,finger.z,finger.rx\n0,0,0,0\n0.1,0.5,-0.7,0.572957795130823\n");
  const std::vector<std::vector<std::string>> ways{ { "--demo" },
                                                    { "--activations", folder / "table.csv", "--seconds", "0.3" },
                                                    { "--expression", "shorten", "--bone",
                                                      "finger=0,0,-0.7,0.572957795130823,0,0", "--ramp", "0.1",
                                                      "--seconds", "0.3" } };
  std::string first;
  for (const auto& way : ways)
  {
    std::vector<std::string> arguments{
      "run", folder / "bar.vtkhdf", "--backend", "cpu", "--frames", folder / "frames"
    };
    arguments.insert(arguments.end(), way.begin(), way.end());
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.code, 0) << result.errors;
    const std::string table = text_of(folder / "frames" + "/reactions.csv");
    expect_contains(table, "\n15,0.300000,touch,");
    if (first.empty())
      first = table;
    EXPECT_EQ(table, first) << way[0];
  }
  EXPECT_EQ(run_program({ "run", folder / "bar.vtkhdf", "--demo", "--expression", "shorten" }).code, 2);
}

TEST(Bake, says_where_loads_act)
{
  const TemporaryFolder folder;
  const std::string scene = folder / "box.yaml";
  std::ofstream(scene) << text_of(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/ros/small.yaml") << R"(
loads:
  - {name: press, pressure: 100 Pa, surface: bar}
  - {name: pull, displacement: [0, 0, 1], surface: bar, within: 0.5, crop: {upper: [null, null, -13]}}
)";
  const ProgramResult baked = run_program({ "bake", scene, "-o", folder / "box.vtkhdf", "--report" });
  ASSERT_EQ(baked.code, 0) << baked.errors;
  expect_contains(baked.output, "load     press: pressure on 14 cm2\n");
  expect_contains(baked.output, "load     pull: displacement of 9 nodes\n");  // of the lower end
}

}  // namespace
}  // namespace frontalis
