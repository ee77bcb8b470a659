#include "program.hpp"

#include "frontalis/render/face_appearance.hpp"

#include <png.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

namespace frontalis
{
namespace
{

const std::string scene = FRONTALIS_SOURCE_DIRECTORY "/test/ros/camera.yaml";
constexpr int width = 64, height = 48;

std::vector<std::string> dataset(const std::string& folder, const std::vector<std::string>& more)
{
  std::vector<std::string> arguments{ "dataset",   scene, "-o",        folder, "--size",    "64,48",
                                      "--backend", "cpu", "--threads", "1",    "--seconds", "0.05" };
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::map<std::string, std::string> files_of(const std::string& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files[entry.path().filename()] = text_of(entry.path());
  return files;
}

std::vector<nlohmann::json> lines_of(const std::string& text)
{
  std::vector<nlohmann::json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(json_from(line));
  return lines;
}

std::vector<std::uint16_t> depth_of(const std::string& bytes)
{
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  EXPECT_EQ(image.width, unsigned{ width });
  EXPECT_EQ(image.height, unsigned{ height });
  EXPECT_TRUE(image.format & PNG_FORMAT_FLAG_LINEAR);
  image.format = PNG_FORMAT_LINEAR_Y;
  std::vector<std::uint16_t> pixels(std::size_t{ width } * height);
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  return pixels;
}

TEST(Dataset, EqualSeedsGiveEqualFilesAndLabelsAgreeWithImages)
{
  const TemporaryFolder folder;
  for (const std::string name : { "first", "second" })
    ASSERT_EQ(run_program(dataset(folder / name, { "--frames", "4", "--seed", "7" })).code, 0);
  const auto files = files_of(folder / "first");
  EXPECT_EQ(files.size(), 2 + 4 * 4u);
  EXPECT_EQ(files, files_of(folder / "second"));
  ASSERT_EQ(run_program(dataset(folder / "other", { "--frames", "1", "--seed", "8" })).code, 0);
  EXPECT_NE(files.at("000000_colour.png"), text_of(folder / "other/000000_colour.png"));

  const nlohmann::json whole = json_from(files.at("dataset.json"));
  EXPECT_EQ(whole["labels"], label_names());
  const auto lines = lines_of(files.at("frames.jsonl"));
  ASSERT_EQ(lines.size(), 4u);
  int visible = 0, hidden = 0;
  for (const nlohmann::json& line : lines)
  {
    EXPECT_GT(line["activation"]["lift"], 0.01);
    const auto& camera = line["camera"];
    const auto depth = depth_of(files.at(line["images"]["depth"]));
    for (const auto& landmark : line["landmarks"])
    {
      const auto pixel = landmark["pixel"].get<std::array<double, 2>>();
      const auto place = landmark["camera_m"].get<std::array<double, 3>>();
      EXPECT_NEAR(pixel[0], camera["cx"].get<double>() + camera["fx"].get<double>() * place[0] / place[2], 1e-9);
      ++(landmark["visible"] ? visible : hidden);
      if (!landmark["visible"])
        continue;
      const auto at = static_cast<std::size_t>(std::lround(pixel[1]) * width + std::lround(pixel[0]));
      EXPECT_NEAR(depth.at(at) * whole["depth_unit_m"].get<double>(), place[2], 1.5e-3);
    }
  }
  EXPECT_GT(visible, 4);
  EXPECT_GT(hidden, 0);
}

TEST(Dataset, WhatWasWrittenBeforeAnInterruptStaysValidAndIsContinued)
{
  const TemporaryFolder folder;
  const std::string cut = folder / "cut", list = cut + "/frames.jsonl";
  ASSERT_EQ(run_program(dataset(cut, { "--frames", "2000" }), cut + "/000002_colour.png").code, 130);
  const std::size_t count = lines_of(text_of(list)).size();
  ASSERT_GE(count, 2u);
  ASSERT_LT(count, 2000u);
  // what does not continue the set is refused, and leaves it as it was
  const auto files = files_of(cut);
  const std::string next = std::to_string(count);
  auto too_small = dataset(cut, {});
  std::replace(too_small.begin(), too_small.end(), std::string("64,48"), std::string("0,48"));
  for (const auto& [arguments, reason] :
       { std::pair{ dataset(cut, { "--first", std::to_string(count - 1) }), "--first must be " + next },
         { dataset(cut, { "--first", next, "--seed", "2" }), std::string("made with seed 1, this run has 2") },
         { dataset(cut, { "--frames", "1" }), "--first must be " + next },
         { too_small, std::string("0 x 48 pixels") } })
  {
    const ProgramResult refused = run_program(arguments);
    EXPECT_EQ(refused.code, 1);
    expect_contains(refused.errors, reason);
    EXPECT_EQ(files_of(cut), files);
  }
  // as after a power failure
  std::ofstream(list, std::ios::app) << R"({"frame":)" << next;
  ASSERT_EQ(run_program(dataset(cut, { "--frames", "2", "--first", next })).code, 0);
  ASSERT_EQ(run_program(dataset(folder / "whole", { "--frames", std::to_string(count + 2) })).code, 0);
  EXPECT_EQ(text_of(list), text_of(folder / "whole/frames.jsonl"));
}

TEST(Gltf, HasTheSkinAtRestAndAMorphTargetPerActionUnit)
{
  const TemporaryFolder folder;
  const std::string path = folder / "face.glb";
  ASSERT_EQ(run_program({ "gltf", scene, "-o", path, "--backend", "cpu", "--seconds", "0.2" }).code, 0);
  const std::string file = text_of(path);
  const auto number = [&](std::size_t at)
  {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  ASSERT_EQ(file.substr(0, 4), "glTF");
  ASSERT_EQ(number(8), file.size());
  const std::size_t text = number(12), buffer = 20 + text + 8;
  ASSERT_EQ(buffer + number(20 + text), file.size());
  const nlohmann::json json = json_from(file.substr(20, text));
  const auto& mesh = json["meshes"][0];
  EXPECT_EQ(mesh["extras"]["targetNames"], (std::vector<std::string>{ "AU1", "AU2" }));
  ASSERT_EQ(mesh["primitives"].size(), 5u);  // skin, iris, finger, eyeball and the dark ball behind it
  const auto& skin = mesh["primitives"][0];
  const auto& place = json["accessors"][skin["attributes"]["POSITION"].get<std::size_t>()];
  // y is up: the bar is 20 mm high
  EXPECT_NEAR(place["min"][1].get<double>(), -0.01, 1e-6);
  EXPECT_NEAR(place["max"][1].get<double>(), 0.01, 1e-6);
  ASSERT_EQ(skin["targets"].size(), 2u);
  const auto lift = [&](std::size_t target)
  { return json["accessors"][skin["targets"][target]["POSITION"].get<std::size_t>()]["max"][1].get<double>(); };
  EXPECT_GT(lift(1), 0.5e-3);
  EXPECT_GT(lift(0), 1.5 * lift(1));
  // AU2 moves the finger down by 3 mm
  const auto& finger = json["accessors"][mesh["primitives"][2]["targets"][1]["POSITION"].get<std::size_t>()];
  EXPECT_NEAR(finger["min"][1].get<double>(), -3e-3, 1e-6);
  EXPECT_NEAR(finger["max"][1].get<double>(), -3e-3, 1e-6);
  for (const auto& view : json["bufferViews"])
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), file.size() - buffer);
}

}  // namespace
}  // namespace frontalis
