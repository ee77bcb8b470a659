// `frontalis run` on models and scenes, end to end

#include "cli/bar_model.hpp"
#include "cli/ply_file.hpp"
#include "cli/program.hpp"

#include "frontalis/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>

namespace frontalis
{
namespace
{

// motion of a landmark in run.json: forward, left, up [mm]
std::array<double, 3> motion_in(const std::string& json, const std::string& landmark)
{
  const nlohmann::json motion = json_from(json).at("landmarks").at(landmark);
  return { motion.at("forward_mm"), motion.at("left_mm"), motion.at("up_mm") };
}

std::vector<std::string> names_in(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

// The bar's model, in a file whose name does not reveal its type.
class RunModel : public testing::Test
{
protected:
  void SetUp() override { write_model(bar_model(), model); }

  TemporaryFolder folder;
  std::string model = folder / "bar.vtkhdf";
  std::string frames = folder / "frames";
};

TEST_F(RunModel, writes_the_height_of_fine_lines)
{
  Model film = bar_model();
  film.film.laws = { FilmLaw{ 1e-4, 1e6, 0.49, 1e4, 0 } };
  film.film.law.assign(film.skin.vertices.size(), 0);
  film.film.carried = film.skin.triangles;
  write_model(film, model);
  const ProgramResult result =
      run_program({ "run", model, "--backend", "cpu", "--seconds", "0.02", "--frames", frames, "--vtp" });
  ASSERT_EQ(result.code, 0) << result.errors;
  const std::string bytes = text_of(frames + "/skin_0000.ply"), end = "property float line_height\nelement face 2\n";
  expect_contains(bytes, end);
  const std::size_t body = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.size(), body + 28 * film.skin.vertices.size() + 13 * film.skin.triangles.size());
  expect_contains(text_of(frames + "/skin_0000.vtp"), "line_height");
}

TEST_F(RunModel, shortens_the_bar_and_writes_its_frames)
{
  const ProgramResult result = run_program(
      { "run", model, "--backend", "cpu", "--activate", "pull=0.5", "--seconds", "0.3", "--frames", frames });
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* word :
       { "backend", "voxels             32 of 2 x 2 x 2 mm", "nodes              81", "time step", "kinetic/internal",
         "hourglass share", "worst J", "real-time factor", "element updates", "landmark           tip: -" })
    expect_contains(result.output, word);

  // there is one frame at the start, then 50 frames per second for 0.3 s
  const std::vector<std::string> names = names_in(frames);
  ASSERT_EQ(names.size(), 18U);
  EXPECT_EQ(names[0], "landmarks.csv");
  EXPECT_EQ(names[1], "run.json");
  EXPECT_EQ(names[2], "skin_0000.ply");
  EXPECT_EQ(names[17], "skin_0015.ply");

  // at rest, in the face frame, the free end is 16 mm above the local origin
  const Ply first = read_ply(frames + "/skin_0000.ply");
  ASSERT_EQ(first.vertices.size(), 4U);
  EXPECT_EQ(first.triangles, (std::vector<std::array<std::int32_t, 3>>{ { 0, 1, 2 }, { 1, 3, 2 } }));
  EXPECT_NEAR(first.vertices[1][0], 0.5 + 0.004, 1e-6);
  EXPECT_NEAR(first.vertices[1][1], 0.25, 1e-6);
  EXPECT_NEAR(first.vertices[1][2], -0.125 + 0.016, 1e-6);
  EXPECT_NEAR(first.vertices[1][5], 1, 1e-6);

  // an incompressible bar under a stress of half its shear modulus shortens to 0.874 of its 16 mm; this bar differs a
  // little, because it is compressible and held at one end
  const std::array<double, 3> motion = motion_in(text_of(frames + "/run.json"), "tip");
  EXPECT_NEAR(motion[2], -2.0, 0.3);
  EXPECT_NEAR(motion[0], 0, 0.01);
  EXPECT_NEAR(motion[1], 0, 0.01);
  const Ply last = read_ply(frames + "/skin_0015.ply");
  double up = 0;
  for (const auto& vertex : last.vertices)
    up += (vertex[2] - first.vertices[1][2]) * 1e3 / 4;
  EXPECT_NEAR(up, motion[2], 0.3);

  // the last row of the table has the same motion
  std::istringstream table(text_of(frames + "/landmarks.csv"));
  std::string row;
  std::string last_row;
  int rows = 0;
  while (std::getline(table, row))
  {
    last_row = row;
    ++rows;
  }
  EXPECT_EQ(rows, 1 + 16);
  EXPECT_EQ(last_row.compare(0, 16, "15,0.300000,tip,"), 0) << last_row;
  EXPECT_NEAR(std::stod(last_row.substr(last_row.rfind(',') + 1)), motion[2], 1e-3);
}

TEST_F(RunModel, gives_the_same_bytes_every_time_on_any_number_of_threads)
{
  const std::string other = folder / "other";
  for (const auto& [path, threads] : { std::pair<std::string, const char*>(frames, "1"), { other, "2" } })
    ASSERT_EQ(run_program({ "run", model, "--expression", "shorten", "--seconds", "0.05", "--backend", "cpu",
                            "--threads", threads, "--frames", path })
                  .code,
              0);
  for (const std::string& name : names_in(frames))
    EXPECT_TRUE(name == "run.json" || text_of(frames + "/" + name) == text_of(other + "/" + name)) << name;
}

TEST_F(RunModel, expression_and_listed_activation_are_alike)
{
  const std::vector<std::string> common = { "--seconds", "0.05", "--frames", frames };
  std::vector<std::string> arguments = { "run", model, "--expression", "shorten" };
  arguments.insert(arguments.end(), common.begin(), common.end());
  ASSERT_EQ(run_program(arguments).code, 0);
  const std::string by_expression = text_of(frames + "/landmarks.csv");
  arguments = { "run", model, "--activate", "pull=0.5" };
  arguments.insert(arguments.end(), common.begin(), common.end());
  ASSERT_EQ(run_program(arguments).code, 0);
  EXPECT_EQ(text_of(frames + "/landmarks.csv"), by_expression);
}

TEST_F(RunModel, replaces_the_frames_of_an_earlier_run_and_nothing_else)
{
  std::filesystem::create_directories(frames);
  for (const char* name : { "skin_0099.ply", "skin_0001.ply.partial", "notes.txt" })
    std::ofstream(frames + "/" + name) << "old";
  ASSERT_EQ(run_program({ "run", model, "--seconds", "0.02", "--frames", frames }).code, 0);
  EXPECT_EQ(names_in(frames),
            (std::vector<std::string>{ "landmarks.csv", "notes.txt", "run.json", "skin_0000.ply", "skin_0001.ply" }));
  EXPECT_EQ(text_of(frames + "/notes.txt"), "old");
}

TEST_F(RunModel, is_recognised_by_its_content_too)
{
  const std::string plain = folder / "bar.model";
  std::filesystem::copy_file(model, plain);
  EXPECT_EQ(run_program({ "run", plain, "--seconds", "0.01" }).code, 0);
}

TEST_F(RunModel, unknown_muscles_and_expressions_are_told_with_those_that_exist)
{
  ProgramResult result = run_program({ "run", model, "--activate", "pul=0.5,pull=0.1,push=1", "--frames", frames });
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.errors,
            "no muscle is called 'pul' (did you mean 'pull'?), 'push' (did you mean 'pull'?); the muscles are pull\n");
  EXPECT_FALSE(std::filesystem::exists(frames));
  result = run_program({ "run", model, "--expression", "smile" });
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.errors, "no expression is called 'smile'; there is relax, shorten\n");
  for (const char* value : { "1.5", "-0.1", "nan" })
  {
    result = run_program({ "run", model, "--activate", std::string("pull=") + value });
    EXPECT_EQ(result.code, 1) << value;
    expect_contains(result.errors, "must be from 0 to 1");
  }
}

TEST_F(RunModel, bones_are_moved_and_bad_motions_refused)
{
  Model held = bar_model();
  held.bones = { "jaw" };
  for (RigidNode& node : held.rigid)
    node.bone = 0;
  const std::string path = folder / "held.vtkhdf";
  write_model(held, path);
  ProgramResult result =
      run_program({ "run", path, "--seconds", "0.2", "--bone", "jaw=0,0,3,0,10,0", "--frames", frames });
  EXPECT_EQ(result.code, 0) << result.errors;
  const std::string moved = text_of(frames + "/landmarks.csv");
  result = run_program({ "run", path, "--seconds", "0.2", "--frames", frames });
  EXPECT_EQ(result.code, 0) << result.errors;
  EXPECT_NE(moved, text_of(frames + "/landmarks.csv"));
  for (const char* text : { "jaw", "jaw=1,2,3", "jaw=0,0,0,0,0,x", "jaw=0,0,0,0,0,0,0", "=0,0,0,0,0,0" })
    EXPECT_EQ(run_program({ "run", path, "--bone", text }).code, 2) << text;
  EXPECT_EQ(run_program({ "run", path, "--bone", "jaw=1,0,0,0,0,0", "--bone", "jaw=2,0,0,0,0,0" }).code, 2);
  result = run_program({ "run", path, "--bone", "skull=0,0,0,0,0,0" });
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.errors, "no bone is called 'skull'; the bones are jaw\n");
  result = run_program({ "run", path, "--bone", "jaw=nan,0,0,0,0,0" });
  EXPECT_EQ(result.code, 1);
  expect_contains(result.errors, "must be finite and rigid");
}

TEST_F(RunModel, a_motion_that_diverges_ends_with_an_error_and_no_frame_of_it)
{
  Model pulled = bar_model();
  Load load;
  load.name = "tear";
  load.value = { 1e30, 0, 0 };
  load.mesh = pulled.skin;
  load.binding = pulled.skin_binding;
  pulled.loads.push_back(load);
  write_model(pulled, model);
  const ProgramResult result =
      run_program({ "run", model, "--backend", "cpu", "--seconds", "0.5", "--frames", frames });
  EXPECT_EQ(result.code, 1);
  for (const char* part : { "the motion is unstable", "no longer finite", "voxel", "flesh", "load tear" })
    expect_contains(result.errors, part);
  // without the guard the message has fewer details
  const ProgramResult unwatched = run_program({ "run", model, "--seconds", "0.5", "--frames", frames, "--guard", "0" });
  EXPECT_EQ(unwatched.code, 1);
  expect_contains(unwatched.errors, "the motion diverged");
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  for (const std::string& name : names_in(frames))
  {
    if (name.compare(0, 5, "skin_") != 0)
      continue;
    for (const auto& vertex : read_ply(frames + "/" + name).vertices)
      for (const float number : vertex)
        EXPECT_TRUE(std::isfinite(number)) << name;
  }
}

TEST_F(RunModel, interrupted_leaves_whole_files_and_130)
{
  const ProgramResult result = run_program({ "run", model, "--backend", "cpu", "--activate", "pull=0.5", "--seconds",
                                             "10000", "--frame-rate", "50", "--wrinkles", "--frames", frames },
                                           frames + "/skin_0003.ply");
  EXPECT_EQ(result.code, 130);
  EXPECT_EQ(result.errors, "interrupted\n");
  EXPECT_EQ(result.output.find("wrinkles   "), std::string::npos) << "were measured after the interrupt";
  std::size_t skins = 0;
  for (const std::string& name : names_in(frames))
  {
    EXPECT_EQ(name.find(".partial"), std::string::npos) << name;
    if (name.compare(0, 5, "skin_") == 0)
    {
      ++skins;
      EXPECT_EQ(read_ply(frames + "/" + name).vertices.size(), 4U) << name;
    }
  }
  const nlohmann::json json = json_from(text_of(frames + "/run.json"));
  EXPECT_EQ(json.at("complete"), false);
  EXPECT_EQ(json.at("frames"), skins);
}

// As the muscle begins to pull, the time step falls to a ten-millionth, so that not even the slice ends in which this
// happens. Nothing moves, because only one node in the middle of the bar is free.
TEST_F(RunModel, interrupted_within_an_endless_slice_ends_too)
{
  Model held = bar_model();
  held.muscles[0].stress_reference = 1e18;
  held.time_step_estimate = TimeStepEstimate::assembled;
  held.rigid.clear();
  for (std::size_t n = 0; n < held.nodes.size(); ++n)
    if (held.nodes[n] != std::array<std::int32_t, 3>{ 4, 1, 1 })
      held.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  write_model(held, model);
  const std::string table = folder / "activations.csv";
  std::ofstream(table) << "time,pull\n0,0\n0.05,0\n0.45,1\n";
  for (const char* guard : { "0", "512" })
  {
    // An interrupt that comes before the slice begins, after two frames, is sent again in another run.
    int written = 2;
    for (int attempt = 0; attempt < 10 && written == 2; ++attempt)
    {
      const ProgramResult result = run_program({ "run", model, "--backend", "cpu", "--activations", table, "--seconds",
                                                 "0.45", "--frame-rate", "20", "--guard", guard, "--frames", frames },
                                               frames + "/skin_0001.ply");
      EXPECT_EQ(result.code, 130) << guard;
      EXPECT_EQ(result.errors, "interrupted\n");
      const nlohmann::json json = json_from(text_of(frames + "/run.json"));
      EXPECT_EQ(json.at("complete"), false);
      written = json.at("frames");
      std::filesystem::remove_all(frames);
    }
    EXPECT_EQ(written, 3) << guard;
  }
}

TEST_F(RunModel, scene_options_do_not_go_with_it)
{
  for (const char* option : { "--mesh-dir", "--accuracy", "--voxel" })
  {
    const ProgramResult result = run_program({ "run", model, option, "1" });
    EXPECT_EQ(result.code, 2) << option;
    expect_contains(result.errors, std::string(option) + " goes with a scene");
  }
}

TEST_F(RunModel, a_truncated_one_is_refused)
{
  std::filesystem::resize_file(model, std::filesystem::file_size(model) / 2);
  const ProgramResult result = run_program({ "run", model });
  EXPECT_EQ(result.code, 1);
  expect_contains(result.errors, model);
}

// the example of doc/scene.md: a bar of tissue 30 mm long, held at one end
std::string example_scene(const TemporaryFolder& folder)
{
  const std::string document = text_of(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/doc/scene.md");
  const std::string fence = "```yaml\n";
  const std::size_t begin = document.find(fence) + fence.size();
  std::ofstream(folder / "bar.yaml") << document.substr(begin, document.find("```", begin) - begin);
  return folder / "bar.yaml";
}

TEST(RunScene, shortens_the_documented_bar)
{
  const TemporaryFolder folder;
  const std::string scene = example_scene(folder);
  const std::string frames = folder / "frames";
  const ProgramResult result = run_program(
      { "run", scene, "--backend", "cpu", "--expression", "shorten", "--seconds", "0.3", "--frames", frames });
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");

  // the tip moves towards the held end by millimetres and stays on the axis
  const std::array<double, 3> motion = motion_in(text_of(frames + "/run.json"), "tip");
  EXPECT_LT(motion[0], -2);
  EXPECT_GT(motion[0], -15);
  EXPECT_NEAR(motion[1], 0, 0.2);
  EXPECT_NEAR(motion[2], 0, 0.2);
  EXPECT_GT(read_ply(frames + "/skin_0001.ply").vertices.size(), 7U);
}

TEST(RunScene, lists_its_arrays_as_json_without_the_stages_of_the_bake)
{
  const TemporaryFolder folder;
  const ProgramResult result = run_program({ "effects", example_scene(folder), "--arrays", "--json" });
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_FALSE(json_from(result.output).empty());
  expect_contains(result.errors, "voxels ...");
}

TEST(RunScene, baked_first_it_moves_the_same)
{
  const TemporaryFolder folder;
  const std::string scene = example_scene(folder);
  const std::string model = folder / "bar.vtkhdf";
  const ProgramResult baked = run_program({ "bake", scene, "-o", model, "--report" });
  ASSERT_EQ(baked.code, 0) << baked.errors;
  EXPECT_EQ(baked.errors, "");
  expect_contains(baked.output, "stage ");
  expect_contains(baked.output, "voxels   192 of 2.5 x 2.5 x 2.5 mm");
  for (const std::string& input : { scene, model })
    ASSERT_EQ(
        run_program({ "run", input, "--activate", "pull=0.3", "--seconds", "0.05", "--frames", input + ".frames" })
            .code,
        0);
  for (const char* name : { "landmarks.csv", "skin_0000.ply", "skin_0002.ply" })
    EXPECT_EQ(text_of(scene + ".frames/" + name), text_of(model + ".frames/" + name)) << name;

  // another bake of the same scene gives the same bytes
  ASSERT_EQ(run_program({ "bake", scene, "-o", folder / "again.vtkhdf" }).code, 0);
  EXPECT_EQ(text_of(model), text_of(folder / "again.vtkhdf"));
}

TEST(RunScene, voxel_edge_is_taken_in_the_scenes_unit)
{
  const TemporaryFolder folder;
  const std::string scene = example_scene(folder);
  for (const char* edge : { "5", "0.5 cm" })
  {
    const ProgramResult result = run_program({ "run", scene, "--voxel", edge, "--seconds", "0.01" });
    ASSERT_EQ(result.code, 0) << result.errors;
    expect_contains(result.output, "of 5 x 5 x 5 mm");
  }
}

}  // namespace
}  // namespace frontalis
