#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/posed_face.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "frontalis/render/png.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/study/step_time.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

namespace frontalis
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double degree = physics::pi / 180;
constexpr double depth_unit = 1e-4;   // depth of one unit of the 16-bit depth images [m]
constexpr int most_units = 4;         // largest number of action units that act at the same time
constexpr double most_intensity = 2;  // largest sum of the intensities of action units

struct DatasetOptions
{
  ModelSource source;
  std::string folder;
  std::vector<int> size{ 640, 480 };
  int frames = 100, first = 0, samples = 2;
  std::uint64_t seed = 1;
  double seconds = 0.3;
  SolverSettings solver;
};

/// Random numbers that depend on the seed and the frame only, so that they are the same on every machine.
class Random
{
public:
  Random(std::uint64_t seed, int frame)
  {
    std::seed_seq both{ static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                        static_cast<std::uint32_t>(frame) };
    engine_.seed(both);
  }
  double between(double low, double high)
  {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

private:
  std::mt19937_64 engine_;
};

struct RandomFrame
{
  std::map<std::string, double> units;
  PinholeCamera camera;
  Light light;
};

std::array<double, 3> direction(double yaw, double pitch)
{
  return { std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch) };
}

// Makes the random choices for a frame. `low`, `high`: corners of the box around the skin at rest.
RandomFrame choose(Random random, const DatasetOptions& options, const Model& model, const std::array<double, 3>& low,
                   const std::array<double, 3>& high)
{
  RandomFrame chosen;
  const int count = 1 + static_cast<int>(random.between(0, most_units));
  double sum = 0;
  for (int n = 0; n < count; ++n)
  {
    const auto unit = static_cast<std::size_t>(random.between(0, static_cast<double>(model.action_units.size())));
    double& intensity = chosen.units[model.action_units[unit].name];
    sum -= intensity;
    intensity = random.between(0.2, 1);
    sum += intensity;
  }
  for (auto& [name, intensity] : chosen.units)
    intensity *= std::min(1.0, most_intensity / sum);

  chosen.camera = camera_with(options.size[0], options.size[1], random.between(25, 50) * degree);
  std::array<double, 3> target{};
  double extent = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    target[i] = 0.5 * (low[i] + high[i]) + random.between(-0.05, 0.05) * (high[i] - low[i]);
    extent = std::max(extent, high[i] - low[i]);
  }
  // The face fills 45 to 90 % of the shorter side of the image.
  const double distance =
      chosen.camera.fx * extent / (random.between(0.45, 0.9) * std::min(options.size[0], options.size[1]));
  // Random numbers are drawn one by one, because compilers choose the order of arguments.
  const auto random_direction = [&random](double yaw, double pitch_min, double pitch_max)
  {
    const double turn = random.between(-yaw, yaw), rise = random.between(pitch_min, pitch_max);
    return direction(turn * degree, rise * degree);
  };
  const auto from = random_direction(50, -25, 25);
  chosen.camera.to_camera =
      look_at({ target[0] + distance * from[0], target[1] + distance * from[1], target[2] + distance * from[2] },
              target, random.between(-15, 15) * degree);

  chosen.light.key = random_direction(70, -10, 60);
  chosen.light.fill = random_direction(90, -10, 60);
  chosen.light.key_strength = random.between(0.45, 0.85);
  chosen.light.fill_strength = random.between(0.1, 0.35);
  chosen.light.ambient = random.between(0.25, 0.45);
  for (float& channel : chosen.light.background)
    channel = static_cast<float>(random.between(0, 1));
  return chosen;
}

Json json_of(const RigidTransform& pose)
{
  return { { "rotation", pose.rotation }, { "translation_m", pose.translation } };
}

Json labels_of(const Model& model, const RandomFrame& chosen, const Renderer& renderer, const SkinState& skin,
               const PosedFace& face)
{
  const PinholeCamera& camera = chosen.camera;
  Json json;
  json["camera"] = { { "fx", camera.fx }, { "fy", camera.fy }, { "cx", camera.cx }, { "cy", camera.cy } };
  json["face_to_camera"] = json_of(camera.to_camera);
  json["light"] = { { "key", chosen.light.key },
                    { "key_strength", chosen.light.key_strength },
                    { "fill", chosen.light.fill },
                    { "fill_strength", chosen.light.fill_strength },
                    { "ambient", chosen.light.ambient } };
  json["action_units"] = chosen.units;
  for (const char* mapping : { "activation", "bones", "landmarks" })
    json[mapping] = Json::object();
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
    json["activation"][model.muscles[m].name] = face.activation()[m];
  for (std::size_t b = 0; b < model.bones.size(); ++b)
    json["bones"][model.bones[b]] = json_of(motion_in_face(model, face.controls().bone[b]));
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const auto& p = skin.landmarks[l];
    const std::array<double, 3> in_camera = camera.to_camera(p);
    Json& landmark = json["landmarks"][model.landmarks[l]];
    landmark = { { "face_m", p }, { "camera_m", in_camera }, { "pixel", nullptr }, { "visible", false } };
    if (in_camera[2] > 0)
    {
      landmark["pixel"] = camera.project(in_camera);
      landmark["visible"] = renderer.sees({ p[0], p[1], p[2] });
    }
  }
  return json;
}

// Writes the images of a frame and returns their names.
Json write_images(const std::string& folder, int frame, const Images& images, int width, int height)
{
  std::vector<std::uint16_t> depth(images.depth.size());
  std::transform(images.depth.begin(), images.depth.end(), depth.begin(),
                 [](float z)
                 {
                   const double steps = std::round(z / depth_unit);
                   return static_cast<std::uint16_t>(steps > 65535 ? 0 : steps);
                 });
  std::vector<std::uint8_t> normal(3 * images.normal.size());
  for (std::size_t i = 0; i < normal.size(); ++i)
    normal[i] = static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * images.normal[i / 3][i % 3]));
  Json names;
  const auto write = [&](const char* kind, const std::string& png)
  {
    const std::string name = fmt::format("{:06}_{}.png", frame, kind);
    write_text(folder + "/" + name, png);
    names[kind] = name;
  };
  write("colour", png_of(images.colour[0].data(), width, height, 3));
  write("depth", png_of(depth.data(), width, height));
  write("labels", png_of(images.label.data(), width, height, 1));
  write("normals", png_of(normal.data(), width, height, 3));
  return names;
}

// Throws Error if the data set that is to be continued was made with other options.
void check_same(const std::string& file, const Json& now)
{
  std::ifstream in(file);
  // The file is missing if this folder continues a data set that another machine began.
  if (!in)
    return;
  const Json before = Json::parse(in, nullptr, false);
  for (const auto& [key, value] : now.items())
    if (const Json found = before.is_object() ? before.value(key, Json()) : Json(); found != value)
      throw Error(
          fmt::format("{}: this data set was made with {} {}, this run has {}; to continue it, use the options with "
                      "which it was made",
                      file, key, found.dump(), value.dump()));
}

// Removes a last line that was not written completely. Throws Error if the list already has frames from `first` on.
void check_list(const std::string& list, int first)
{
  std::ifstream in(list, std::ios::binary);
  if (!in)
    return;
  std::uintmax_t size = 0;
  int next = 0;
  for (std::string line; std::getline(in, line) && !in.eof(); size += line.size() + 1)
  {
    const Json json = Json::parse(line, nullptr, false);
    const Json frame = json.is_object() ? json.value("frame", Json()) : Json();
    if (!frame.is_number_integer())
      throw Error(fmt::format("{}: the line at byte {} is not that of a frame", list, size));
    next = std::max(next, frame.get<int>() + 1);
  }
  if (next > first)
    throw Error(fmt::format("{}: has frame {} already; --first must be {} or more, or the folder another one", list,
                            next - 1, next));
  std::filesystem::resize_file(list, size);
}

void write_dataset(const DatasetOptions& options)
{
  camera_with(options.size[0], options.size[1], 1);  // throws Error on wrong sizes before anything is written
  const std::string description_file = options.folder + "/dataset.json", list = options.folder + "/frames.jsonl";
  check_list(list, options.first);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  if (model->action_units.empty())
    throw Error(
        options.source.path +
        ": has no action units, of which expressions are mixed; give it some, such as `action_units: facs.yaml`");
  const Json description{ { "scene_hash", model->scene_hash }, { "seed", options.seed },
                          { "seconds", options.seconds },      { "samples", options.samples },
                          { "width", options.size[0] },        { "height", options.size[1] },
                          { "depth_unit_m", depth_unit },      { "labels", label_names() } };
  if (options.first > 0)
    check_same(description_file, description);
  make_folder(options.folder);
  write_text(description_file, json_text(description));
  std::ofstream lines(list, options.first > 0 ? std::ios::app : std::ios::trunc);

  PosedFace face(model, options.solver);
  const FaceAppearance appearance(*model, face.rest());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{ infinity, infinity, infinity }, high{ -infinity, -infinity, -infinity };
  for (const auto& vertex : face.rest().vertices)
    for (std::size_t i = 0; i < 3; ++i)
    {
      low[i] = std::min(low[i], double(vertex[i]));
      high[i] = std::max(high[i], double(vertex[i]));
    }

  Progress progress;
  std::vector<int> unstable;
  const double begin = wall_seconds();
  for (int frame = options.first; frame < options.first + options.frames; ++frame)
  {
    const RandomFrame chosen = choose(Random(options.seed, frame), options, *model, low, high);
    try
    {
      const SkinState& skin = face.take(
          action_unit_controls(*model, chosen.units), options.seconds,
          [&](double done) { progress.update("drawing", (frame - options.first + 0.9 * done) / options.frames); });
      const Renderer renderer(appearance.scene(skin, face.controls()), chosen.camera);
      Json line{ { "frame", frame } };
      line["images"] = write_images(options.folder, frame, renderer.images(chosen.light, options.samples),
                                    options.size[0], options.size[1]);
      line.update(labels_of(*model, chosen, renderer, skin, face));
      // A line is written only after the images that it names are complete.
      lines << line.dump() + "\n" << std::flush;
      if (!lines)
        throw Error(list + ": cannot be written");
    }
    catch (const Unstable&)
    {
      unstable.push_back(frame);
    }
  }
  progress.clear();
  fmt::print("{} frames in {}, {:.1f} per minute\n", static_cast<std::size_t>(options.frames) - unstable.size(),
             options.folder, 60 * options.frames / (wall_seconds() - begin));
  if (!unstable.empty())
    fmt::print("left out, because their motions were unstable: {}\n", fmt::join(unstable, ", "));
}

}  // namespace

void add_dataset_command(CLI::App& app)
{
  const auto options = std::make_shared<DatasetOptions>();
  CLI::App* command = app.add_subcommand(
      "dataset", "write images of random expressions, poses and lights of a face, with exact labels");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("-o,--output", options->folder, "folder for the images, frames.jsonl and dataset.json")
      ->required();
  command->add_option("--frames", options->frames, "number of frames (100)")->check(CLI::Range(1, 1000000));
  command->add_option("--seed", options->seed, "equal seeds give equal files (1)");
  command
      ->add_option("--first", options->first,
                   "number of the first frame (0); from 1 on, lines are added to frames.jsonl: continues after Ctrl-C")
      ->check(CLI::Range(0, 999999));
  command->add_option("--size", options->size, "width and height of the images: W,H [pixels] (640,480)")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--samples", options->samples, "rays per pixel along each axis, of colours (2)")
      ->check(CLI::Range(1, 16));
  add_positive(*command, "--seconds", options->seconds, "simulated seconds from rest to a picture (0.3)");
  add_solver_options(*command, options->solver);
  add_scene_options(*command, options->source);
  command->callback([options] { write_dataset(*options); });
}

}  // namespace frontalis
