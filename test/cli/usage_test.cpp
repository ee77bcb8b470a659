// exit codes and messages of the program for wrong usage, bad scenes and paths that cannot be written

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace frontalis
{
namespace
{

const std::string bad_folder = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/scene/bad";

TEST(Usage, version_and_help_end_well)
{
  const ProgramResult version = run_program({ "--version" });
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.output.compare(0, 10, "frontalis "), 0) << version.output;
  for (const std::vector<std::string>& arguments :
       { std::vector<std::string>{ "--help" }, { "run", "--help" }, { "bake", "--help" } })
  {
    const ProgramResult help = run_program(arguments);
    EXPECT_EQ(help.code, 0);
    expect_contains(help.output, "Usage: ");
  }
}

TEST(Usage, wrong_options_end_with_2_and_one_message)
{
  const std::string scene = bad_folder + "/empty_volume.yaml";
  const std::vector<std::vector<std::string>> wrong = {
    {},
    { "simulate" },
    { "run" },
    { "bake", scene },
    { "run", scene, "--unknown" },
    { "run", scene, "--seconds" },
    { "run", scene, "--seconds", "soon" },
    { "run", scene, "--seconds", "-1" },
    { "run", scene, "--seconds", "0" },
    { "run", scene, "--seconds", "inf" },
    { "run", scene, "--ramp", "-1" },
    { "run", scene, "--frame-rate", "0" },
    { "run", scene, "--backend", "abacus" },
    { "run", scene, "--threads", "-2" },
    { "run", scene, "--activate", "strand" },
    { "run", scene, "--activate", "strand=much" },
    { "run", scene, "--activate", "strand=0.1,strand=0.2" },
    { "run", scene, "--activate", "=0.1" },
    { "run", scene, "--vtp" },
    { "run", scene, "--vtu" },
    { "fit", scene },
    { "rest", scene, "-o", "rest.vtkhdf" },
    { "rest", scene, "-o", "rest.vtkhdf", "--creases", "smile" },
    { "rest", scene, "-o", "rest.vtkhdf", "--neutral", "--set", "0.5" },
    { "retarget", scene, "-o", "found.csv" },
    { "gltf", scene, "-o", "found.csv" },
    { "calibrate", scene, "joints.csv", "landmarks.csv" },
    { "run", scene, "--ramp", "0.1", "--demo" },
    { "run", scene, "--ramp", "0.1", "--to-equilibrium" },
    { "run", scene, "--ramp", "0.1", "--activations", "table.csv" },
    { "run", scene, "--frame-rate", "10", "--to-equilibrium" },
    { "run", scene, "--tolerance", "0.1" },
    { "faces", scene, "--ramp", "nan" },
    { "bench", "--voxel", "2" },
    { "verify", "--only", "no_such_case" },
    { "verify", "--only", "rigid_motion", "--markdown", FRONTALIS_SOURCE_DIRECTORY "/doc/verification.md" },
  };
  for (const std::vector<std::string>& arguments : wrong)
  {
    const ProgramResult result = run_program(arguments);
    const std::string last = arguments.empty() ? "no argument" : arguments.back();
    EXPECT_EQ(result.code, 2) << last;
    EXPECT_NE(result.errors, "") << last;
    EXPECT_EQ(result.output, "") << last;
  }
}

TEST(Usage, output_that_cannot_be_written_is_an_error)
{
  const std::string command = FRONTALIS_PROGRAM " verify --only active_bar > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST(Files, that_are_missing_or_cannot_be_written_are_told)
{
  const TemporaryFolder folder;
  const std::string scene = bad_folder + "/empty_volume.yaml";
  const std::string absent = folder / "absent.yaml";
  for (const std::vector<std::string>& arguments : { std::vector<std::string>{ "run", absent },
                                                     { "run", folder / "absent.vtkhdf" },
                                                     { "bake", absent, "-o", folder / "m.vtkhdf" },
                                                     { "bake", scene, "-o", folder / "none/m.vtkhdf" },
                                                     { "bake", scene, "-o", folder.path() },
                                                     { "gltf", scene, "-o", folder / "none/face.glb" },
                                                     { "faces", scene, "--json", folder / "none/faces.json" },
                                                     { "bake", scene, "-o", scene } })
  {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.code, 1) << arguments.back();
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Files, that_are_not_the_programs_own_are_not_replaced)
{
  const TemporaryFolder folder;
  const std::string notes = folder / "notes.txt", scene = folder / "scene.yaml", model = folder / "m.vtkhdf";
  std::ofstream(notes) << "mine";
  const std::string meshes = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/model/bad/";
  for (const char* name : { "body.obj", "again.obj" })
    std::filesystem::copy_file(meshes + "box.obj", folder / name);
  std::ofstream(scene) << R"(unit: mm
surfaces: {body: {file: body.obj}, again: {file: again.obj}}
volumes: {tissue: {inside: body, material: fat, tissue: true}}
materials: {fat: {young: 3 kPa, poisson: 0.45, density: 1000}}
constraints: [{name: held, rigid: body, crop: {upper: [null, null, 1]}}]
skin: {surface: body}
accuracy: {draft: {voxel: 2.5}}
)";
  const std::string mesh = text_of(folder / "body.obj");
  for (const std::vector<std::string>& arguments : { std::vector<std::string>{ "bake", scene, "-o", notes },
                                                     { "rest", scene, "--neutral", "-o", notes },
                                                     { "bake", scene, "-o", model, "--surfaces", folder.path() } })
  {
    const ProgramResult refused = run_program(arguments);
    EXPECT_EQ(refused.code, 1) << refused.errors;
    EXPECT_NE(refused.errors.find("must be"), std::string::npos) << refused.errors;
  }
  EXPECT_EQ(text_of(notes), "mine");
  EXPECT_EQ(text_of(folder / "body.obj"), mesh);
  EXPECT_FALSE(std::filesystem::exists(model));
  // A model may be replaced, and a cached one has the warnings of its bake.
  for (int time = 0; time < 2; ++time)
  {
    const ProgramResult baked = run_program({ "bake", scene, "-o", model, "--cache", folder / "cache" });
    EXPECT_EQ(baked.code, 0) << baked.errors;
    expect_contains(baked.output, time == 0 ? "kept as" : "taken from");
    expect_contains(baked.output, "surface 'body' has the mesh of 'again'");
  }
}

TEST(Warnings, name_probable_mistakes)
{
  const TemporaryFolder folder;
  const std::string box = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/model/bad/box.obj",
                    scene = folder / "scene.yaml";
  std::ofstream(scene) << "unit: mm\nsurfaces: {body: {file: " << box << "}, puller: {file: " << box
                       << "}, lifter: {file: " << box << R"(}}
volumes: {tissue: {inside: body, material: fat, tissue: true}}
materials: {fat: {young: 3 kPa, poisson: 0.45, density: 1000}}
muscles: {puller: {fibre: [1, 0, 0], material: fat}, lifter: {fibre: [0, 0, 1], material: fat}}
layers: [{name: dermis, surface: body, volume: tissue, material: fat, thickness: 0.002}]
constraints: [{name: held, rigid: body, bone: jaw, crop: {upper: [null, null, 1]}}]
expressions: {open: {bones: {jaw: {turn: [0, 20, 0]}}}}
skin: {surface: body}
accuracy: {draft: {voxel: 2.5}}
)";
  const ProgramResult baked = run_program({ "bake", scene, "-o", folder / "m.vtkhdf" });
  EXPECT_EQ(baked.code, 0) << baked.errors;
  expect_contains(baked.output, "surface 'puller' has the mesh of 'lifter'");
  EXPECT_EQ(baked.output.find("has the mesh of 'body'"), std::string::npos) << "a body may be a muscle as a whole";
  expect_contains(baked.output, "layer 'dermis' is 0.002 mm thick");
  expect_contains(baked.output, "'open' turns bone 'jaw' about the origin of the face frame");
}

class BadSceneRun : public testing::TestWithParam<std::string>
{
};

std::vector<std::string> bad_scenes()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(bad_folder))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST_P(BadSceneRun, ends_with_1_and_its_one_message)
{
  const std::string path = bad_folder + "/" + GetParam() + ".yaml";
  const std::string text = text_of(path);
  const std::string first = text.substr(0, text.find('\n'));
  const ProgramResult result = run_program({ "run", path });
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(result.errors.compare(0, path.size(), path), 0) << result.errors;
  const std::size_t colon = first.find(": ");
  ASSERT_NE(colon, std::string::npos) << "the first line says what is expected";
  expect_contains(result.errors, first.substr(colon + 2));
}

INSTANTIATE_TEST_SUITE_P(scenes, BadSceneRun, testing::ValuesIn(bad_scenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace frontalis
