#include "cli/bar_model.hpp"
#include "cli/program.hpp"

#include "frontalis/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace frontalis
{
namespace
{

class RunModes : public testing::Test
{
protected:
  void SetUp() override { write_model(bar_model(), model); }

  std::string file(const std::string& name, const std::string& text) const
  {
    std::ofstream(folder / name) << text;
    return folder / name;
  }

  TemporaryFolder folder;
  std::string model = folder / "bar.vtkhdf";
  std::string frames = folder / "frames";
};

TEST_F(RunModes, a_table_of_activations_is_a_ramp_where_it_says_so)
{
  const std::string table = file("pull.csv", "time,pull\n\n0,0\n0.05,0.5\n\n0.2,0.5\n");
  const std::string other = folder / "other";
  ASSERT_EQ(run_program({ "run", model, "--activations", table, "--seconds", "0.1", "--frames", frames }).code, 0);
  ASSERT_EQ(
      run_program({ "run", model, "--activate", "pull=0.5", "--ramp", "0.05", "--seconds", "0.1", "--frames", other })
          .code,
      0);
  EXPECT_EQ(text_of(frames + "/landmarks.csv"), text_of(other + "/landmarks.csv"));
}

TEST_F(RunModes, an_effect_that_is_left_out_does_nothing)
{
  ASSERT_EQ(run_program({ "run", model, "--activate", "pull=0.5", "--seconds", "0.1", "--without", "contraction",
                          "--frames", frames })
                .code,
            0);
  const std::string other = folder / "other";
  ASSERT_EQ(run_program({ "run", model, "--seconds", "0.1", "--frames", other }).code, 0);
  EXPECT_EQ(text_of(frames + "/landmarks.csv"), text_of(other + "/landmarks.csv"));
  for (const auto& [name, fault] : { std::pair{ "magic", "there is no effect 'magic'; the effects are elasticity" },
                                     { "viscosity", "the model has no viscosity (no material is viscous)" },
                                     { "elasticity", "elasticity cannot be switched while running" } })
  {
    const auto result = run_program({ "run", model, "--without", name });
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.errors.find(fault), std::string::npos) << result.errors;
  }
}

TEST_F(RunModes, effects_are_listed_with_what_they_cost)
{
  const auto table = run_program({ "effects", model, "--seconds", "0.01", "--backend", "cpu" });
  ASSERT_EQ(table.code, 0) << table.errors;
  for (const char* const part :
       { "contraction", "1 muscle", "viscosity", "no material is viscous", "plain neo-Hookean" })
    EXPECT_NE(table.output.find(part), std::string::npos) << table.output;
  expect_contains(run_program({ "effects", model, "--seconds", "1e-9", "--backend", "cpu" }).output,
                  "every muscle at activation 0, since more --seconds are needed to reach 0.75");
  const auto json = run_program({ "effects", model, "--seconds", "0.01", "--backend", "cpu", "--json" });
  ASSERT_EQ(json.code, 0);
  const nlohmann::json costs = json_from(json.output);
  EXPECT_EQ(costs.at("voxels"), 32);
  for (const char* const time : { "plain_step_us", "step_us" })
    EXPECT_GT(costs.at(time), 0) << time;
  ASSERT_EQ(costs.at("effects").size(), 16U);
  for (const nlohmann::json& effect : costs.at("effects"))
  {
    const bool on = effect.at("on") == "on";
    const bool is_timed = on && effect.at("effect") != "output_fields";
    EXPECT_EQ(effect.at("step [us]").is_number(), is_timed) << effect;
    EXPECT_EQ(effect.at("bytes") == 0, !is_timed) << effect;
  }
  for (const char* const seconds : { "0", "-1", "inf", "nan" })
    EXPECT_EQ(run_program({ "effects", model, "--seconds", seconds }).code, 2) << seconds;
  EXPECT_EQ(run_program({ "effects", model, "--plot", "bars.svg" }).code, 2);
  const auto bench = run_program({ "bench", "--effects", model, "--plot", "shares" });
  EXPECT_EQ(bench.code, 2);
  EXPECT_NE(bench.errors.find("--plot: 'shares' must end in .png"), std::string::npos) << bench.errors;
}

TEST_F(RunModes, a_time_step_is_taken_or_refused)
{
  ASSERT_EQ(run_program({ "run", model, "--time-step", "2e-6", "--seconds", "0.001", "--frames", frames }).code, 0);
  EXPECT_DOUBLE_EQ(json_from(text_of(frames + "/run.json")).at("time_step_s").get<double>(), 2e-6);
  for (const char* const step : { "0.1", "-1e-6", "nan" })
  {
    const ProgramResult result = run_program({ "run", model, "--time-step", step, "--seconds", "0.001" });
    EXPECT_EQ(result.code, 1) << step;
    EXPECT_NE(result.errors.find("refused: allowed is 0 (found by the solver) to the critical"), std::string::npos)
        << result.errors;
  }
}

TEST_F(RunModes, wrong_tables_are_told_with_their_line)
{
  const std::pair<const char*, const char*> tables[] = {
    { "time,push\n0,1\n", ":1: no muscle is called 'push' (did you mean 'pull'?); the muscles are pull" },
    { "time,pull\n0,1\n0,1\n", ":3: time is 0; times must ascend from 0" },
    { "time,pull\n0.1,nan\n", ":2: found 'nan'; must be a number" },
    { "time,pull\n0.1,1.5\n", ":2: activation of 'pull' is 1.5; must be from 0 to 1" },
    { "time,pull\n0.1\n", ":2: found 1 fields; the header has 2" },
    { "time,pull\n", ": has no row below its header" },
    { "time,pull\n\n", ": has no row below its header" },
    { "time,pull\n0.1,\n", ":2: found ''; must be a number" },
    { "time,jaw.up\n0,0\n", ":1: 'jaw.up' is no muscle, nor a bone's .x, .y, .z, .rx, .ry or .rz" },
    { "time,jaw.x\n0,0\n", ":1: no bone is called 'jaw'; the bones are none" },
    { "seconds,pull\n", ":1: the first column must be called time" },
    { "", ": cannot be read, or is empty" },
  };
  for (const auto& [text, expected] : tables)
  {
    const std::string table = file("table.csv", text);
    const ProgramResult result = run_program({ "run", model, "--activations", table, "--seconds", "0.01" });
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.errors.find(table + expected), std::string::npos) << result.errors;
  }
}

TEST_F(RunModes, a_movie_has_a_picture_per_frame)
{
  const auto run_to = [&](const std::string& movie, const std::vector<std::string>& options = {})
  {
    std::vector<std::string> words{ "run",          std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/ros/small.yaml",
                                    "--expression", "shorten",
                                    "--seconds",    "0.1",
                                    "--frame-rate", "50",
                                    "--movie",      folder / movie };
    words.insert(words.end(), options.begin(), options.end());
    return run_program(words);
  };
  const auto pictures = run_to("pictures");
  ASSERT_EQ(pictures.code, 0) << pictures.errors;
  EXPECT_EQ(text_of(folder / "pictures/frame_0000.png").substr(1, 3), "PNG");
  EXPECT_TRUE(text_of(folder / "pictures/frame_0000.png") != text_of(folder / "pictures/frame_0005.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures/frame_0006.png"));
  const std::string oblique = text_of(folder / "pictures/frame_0000.png");
  ASSERT_EQ(run_to("pictures", { "--view", "left", "--picture-height", "190" }).code, 0);
  const std::string left = text_of(folder / "pictures/frame_0000.png");
  EXPECT_EQ(left.substr(16, 8), std::string("\0\0\0\x96\0\0\0\xbe", 8)) << "150 by 190 pixels, in the header";
  ASSERT_EQ(run_to("pictures", { "--view", "front" }).code, 0);
  EXPECT_TRUE(text_of(folder / "pictures/frame_0000.png") != oblique);
  std::filesystem::create_directories(folder / "it's.gif.frames");
  folder.write("it's.gif.frames/notes.txt", "mine");
  const auto joined = run_to("it's.gif");
  if (joined.code != 0 && joined.errors.find("imagemagick") != std::string::npos)
    GTEST_SKIP() << joined.errors;
  ASSERT_EQ(joined.code, 0) << joined.errors;
  const std::string gif = text_of(folder / "it's.gif");
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  // each frame begins with a block that says for how long it is shown: 2 hundredths of a second
  int shown = 0;
  for (auto at = gif.find("\x21\xf9\x04"); at != std::string::npos; at = gif.find("\x21\xf9\x04", at + 1))
    if (gif[at + 4] == 2 && gif[at + 5] == 0)
      ++shown;
  EXPECT_EQ(shown, 6);
  EXPECT_EQ(text_of(folder / "it's.gif.frames/notes.txt"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "it's.gif.frames/frame_0000.png"));
}

// The second plane of nodes passes through the first one after 13 ms, long before the guard's first regular check.
TEST_F(RunModes, a_motion_that_the_guard_stops_leaves_its_good_frames)
{
  Model crushed = bar_model();
  Load press;
  press.name = "press";
  press.kind = Load::Kind::displacement;
  press.value = { -3e-3, 0, 0 };
  press.ramp = 0.02;
  crushed.loads.push_back(press);
  for (std::size_t n = 0; n < crushed.nodes.size(); ++n)
    if (crushed.nodes[n][0] == 1)
      crushed.prescribed.push_back({ static_cast<std::int32_t>(n), 0 });
  write_model(crushed, model);
  const std::string movie = folder / "crushed.gif";
  const ProgramResult result = run_program({ "run", model, "--backend", "cpu", "--seconds", "0.05", "--frame-rate",
                                             "100", "--frames", frames, "--movie", movie });
  EXPECT_EQ(result.code, 1);
  if (result.errors.find("imagemagick") != std::string::npos)
    GTEST_SKIP() << result.errors;
  expect_contains(result.errors, "turn inside out");
  EXPECT_EQ(json_from(text_of(frames + "/run.json")).at("frames"), 2) << "those of 0 and 10 ms";
  EXPECT_EQ(text_of(movie).substr(0, 6), "GIF89a");
}

TEST_F(RunModes, a_movie_that_cannot_be_made_is_an_error_before_the_motion)
{
  std::filesystem::create_directories(folder / "frames");
  folder.write("frames/skin_0000.ply", "of an earlier run");
  const ProgramResult result = run_program({ "run", std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/ros/small.yaml",
                                             "--expression", "shorten", "--seconds", "0.1", "--frame-rate", "30",
                                             "--frames", folder / "frames", "--movie", folder / "a.gif" });
  EXPECT_EQ(result.code, 1);
  expect_contains(result.errors, "a GIF cannot have 30 frames per second");
  const ProgramResult other = run_program({ "run", std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/ros/small.yaml",
                                            "--seconds", "0.1", "--movie", folder / "a.mp4" });
  EXPECT_EQ(other.code, 1);
  expect_contains(other.errors, "only NAME.gif or a folder is written");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
  EXPECT_EQ(text_of(folder / "frames/skin_0000.ply"), "of an earlier run");
}

TEST_F(RunModes, the_ledger_of_a_shortening_bar_closes)
{
  const ProgramResult result =
      run_program({ "run", model, "--activate", "pull=0.5", "--seconds", "0.2", "--ledger", "--frames", frames });
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_NE(result.output.find("energy balance"), std::string::npos);
  const nlohmann::json json = json_from(text_of(frames + "/run.json"));
  const double work = json.at("ledger_muscle_J");
  EXPECT_GT(work, 0);
  EXPECT_LT(std::abs(json.at("ledger_imbalance_J").get<double>()), 0.01 * work);
}

TEST_F(RunModes, equilibrium_is_where_a_damped_motion_ends)
{
  const std::string other = folder / "other";
  ASSERT_EQ(run_program({ "run", model, "--activate", "pull=0.5", "--to-equilibrium", "--frames", frames }).code, 0);
  ASSERT_EQ(run_program({ "run", model, "--activate", "pull=0.5", "--seconds", "2", "--frames", other }).code, 0);
  const double settled = json_from(text_of(frames + "/run.json")).at("landmarks").at("tip").at("up_mm"),
               damped = json_from(text_of(other + "/run.json")).at("landmarks").at("tip").at("up_mm");
  EXPECT_NEAR(settled, damped, 0.01 * std::abs(damped));
  // the table has displacements from rest, though the frame of rest is not written
  const std::string table = text_of(frames + "/landmarks.csv");
  EXPECT_NEAR(std::stod(table.substr(table.rfind(',') + 1)), settled, 1e-4 * std::abs(settled));
}

TEST_F(RunModes, plots_only_forces_that_there_are)
{
  const ProgramResult result =
      run_program({ "run", model, "--activate", "pull=0.5", "--seconds", "0.01", "--plot", folder / "forces.png" });
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.errors.find("--plot draws the forces on bodies that tissue touches; the model has none"),
            std::string::npos)
      << result.errors;
}

TEST_F(RunModes, equilibrium_that_is_not_reached_is_an_error)
{
  const ProgramResult result =
      run_program({ "run", model, "--activate", "pull=0.5", "--to-equilibrium", "--seconds", "0.001" });
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.errors.find("no equilibrium after"), std::string::npos) << result.errors;
}

// the published numbers of Warburton & Maddock (config/published.yaml), on coarse voxels
TEST(PublishedForehead, contracts_to_three_quarters_activation_and_its_energies_balance)
{
  const TemporaryFolder folder;
  const std::string frames = folder / "frames";
  const ProgramResult result =
      run_program({ "run", FRONTALIS_SOURCE_DIRECTORY "/config/published.yaml", "--accuracy", "draft", "--voxel", "5",
                    "--expression", "contract", "--ramp", "0.2", "--seconds", "0.25", "--ledger", "--frames", frames });
  ASSERT_EQ(result.code, 0) << result.errors;
  const nlohmann::json json = json_from(text_of(frames + "/run.json"));
  EXPECT_GT(json.at("landmarks").at("brow_left").at("up_mm"), 5);
  EXPECT_GT(json.at("worst_jacobian"), 0.1);
  EXPECT_LT(std::abs(json.at("ledger_imbalance_J").get<double>()), 0.01 * json.at("ledger_muscle_J").get<double>());
}

TEST_F(RunModes, wrinkles_in_a_box_that_is_the_wrong_way_round_are_wrong_usage)
{
  const ProgramResult result = run_program({ "run", model, "--wrinkles-in=10,0,-10,20" });
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.errors.find("--wrinkles-in: the first corner must be to the right of the second"), std::string::npos)
      << result.errors;
}

// voxels of 3 mm are too coarse for its folds: this is about the brow and what is printed
TEST(LivingForehead, raises_its_brow_as_people_do_and_its_wrinkles_are_measured)
{
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program({ "run", FRONTALIS_SOURCE_DIRECTORY "/config/living_forehead.yaml", "--voxel", "3", "--expression",
                    "raise_left_brow", "--ramp", "0.3", "--seconds", "0.5", "--wrinkles-in=-40,24,40,80", "--frames",
                    folder / "frames" });
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_NE(result.output.find("wrinkles           "), std::string::npos) << result.output;
  const nlohmann::json json = json_from(text_of(folder / "frames" + "/run.json"));
  EXPECT_GT(json.at("landmarks").at("brow_mid_left").at("up_mm"), 5);
  EXPECT_LT(json.at("landmarks").at("brow_mid_left").at("up_mm"), 10);
  EXPECT_LT(std::abs(json.at("landmarks").at("brow_mid_right").at("up_mm").get<double>()), 1);
  EXPECT_FALSE(json.at("wrinkles").at("furrows").empty());
  for (const auto& furrow : json.at("wrinkles").at("furrows"))
    EXPECT_GT(furrow.at("middle_m")[1], -10e-3);
}

TEST(LivingForehead, keeps_creases_of_raised_brows_in_its_shell)
{
  const TemporaryFolder folder;
  const std::string smooth = folder / "smooth.vtkhdf", creased = folder / "creased.vtkhdf";
  ASSERT_EQ(run_program({ "bake", FRONTALIS_SOURCE_DIRECTORY "/config/living_forehead.yaml", "--voxel", "3", "--output",
                          smooth })
                .code,
            0);
  const ProgramResult result = run_program({ "rest", smooth, "--creases", "raise_brows", "--set", "0.5", "--seconds",
                                             "0.05", "--backend", "cpu", "--output", creased });
  ASSERT_EQ(result.code, 0) << result.errors;
  expect_contains(result.output, "creases  0.5 of the folds of raise_brows stay");
  const Model before = read_model(smooth), after = read_model(creased);
  double largest = 0;
  for (std::size_t v = 0; v < before.shells.at(0).surface.vertices.size(); ++v)
    largest = std::max(largest,
                       std::abs(after.shells.at(0).surface.vertices[v][2] - before.shells[0].surface.vertices[v][2]));
  EXPECT_GT(largest, 0.1e-3);
  EXPECT_EQ(after.skin.vertices, before.skin.vertices);
  EXPECT_EQ(run_program({ "rest", smooth, "--creases", "no_such", "--set", "1", "-o", creased }).code, 1);
}

}  // namespace
}  // namespace frontalis
