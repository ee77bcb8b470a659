#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/posed_face.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace frontalis
{
namespace
{

using Json = nlohmann::ordered_json;
using Points = std::vector<std::array<float, 3>>;

struct GltfOptions
{
  ModelSource source;
  std::string file;
  std::vector<std::string> only;
  bool expressions = false;
  double seconds = 0.4;
  SolverSettings solver;
};

// Codes defined by glTF 2.0.
enum : int
{
  unsigned_int = 5125,
  single_float = 5126,
  array_buffer = 34962,
  element_array_buffer = 34963
};

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the bytes of numbers are written as they are in memory");

/// A binary glTF file that is being built: its JSON and its one buffer.
class Glb
{
public:
  /// Adds vectors, or corners of triangles, and returns the index of their accessor.
  int add(const Points& vectors)
  {
    std::array<float, 3> low = vectors.at(0), high = low;
    for (const auto& v : vectors)
      for (std::size_t i = 0; i < 3; ++i)
      {
        low[i] = std::min(low[i], v[i]);
        high[i] = std::max(high[i], v[i]);
      }
    return add(vectors.data(), vectors.size(), array_buffer,
               { { "componentType", single_float }, { "type", "VEC3" }, { "min", low }, { "max", high } });
  }
  int add(const std::vector<std::array<std::int32_t, 3>>& triangles)
  {
    return add(triangles.data(), 3 * triangles.size(), element_array_buffer,
               { { "componentType", unsigned_int }, { "type", "SCALAR" } });
  }

  /// Returns the file with the primitives of one mesh, which has the named morph targets.
  std::string bytes(const Json& primitives, const std::vector<std::string>& targets)
  {
    json_["asset"] = { { "version", "2.0" }, { "generator", "frontalis " FRONTALIS_VERSION } };
    json_["scene"] = 0;
    json_["scenes"] = { { { "nodes", { 0 } } } };
    json_["nodes"] = { { { "name", "face" }, { "mesh", 0 } } };
    json_["materials"] = { { { "doubleSided", true },
                             { "pbrMetallicRoughness", { { "metallicFactor", 0 }, { "roughnessFactor", 0.6 } } } } };
    json_["meshes"] = { { { "primitives", primitives },
                          { "weights", std::vector<int>(targets.size(), 0) },
                          { "extras", { { "targetNames", targets } } } } };
    json_["buffers"] = { { { "byteLength", buffer_.size() } } };
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    if (const std::size_t most = std::numeric_limits<std::uint32_t>::max(); buffer_.size() + text.size() + 28 > most)
      throw Error(
          fmt::format("the file would have {:.1f} GB; glTF allows 4.3: write fewer poses, or without fine lines",
                      1e-9 * static_cast<double>(buffer_.size() + text.size())));
    std::string out = "glTF";
    const auto number = [&out](std::size_t value)
    {
      for (int byte = 0; byte < 4; ++byte)
        out += static_cast<char>(value >> (8 * byte) & 0xff);
    };
    number(2);
    number(12 + 8 + text.size() + 8 + buffer_.size());
    number(text.size());
    out += "JSON" + text;
    number(buffer_.size());
    return out + std::string("BIN\0", 4) + buffer_;
  }

private:
  int add(const void* numbers, std::size_t count, int target, Json accessor)
  {
    const std::size_t bytes = count * (target == array_buffer ? 3 : 1) * sizeof(float);
    json_["bufferViews"].push_back(
        { { "buffer", 0 }, { "byteOffset", buffer_.size() }, { "byteLength", bytes }, { "target", target } });
    buffer_.append(static_cast<const char*>(numbers), bytes);
    accessor["count"] = count;
    accessor["bufferView"] = json_["bufferViews"].size() - 1;
    json_["accessors"].push_back(accessor);
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  Json json_;
  std::string buffer_;
};

// Converts to the axes of glTF: x to the face's left, y up, z out of the face.
Points turned(const Points& in)
{
  Points out;
  out.reserve(in.size());
  for (const auto& [x, y, z] : in)
    out.push_back({ y, z, x });
  return out;
}

Points difference(Points now, const Points& rest)
{
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      now[i][c] -= rest[i][c];
  return now;
}

// A ball as a mesh: rings of points from pole to pole.
RenderMesh mesh_of(const RenderBall& ball)
{
  constexpr int rings = 24, columns = 48;
  using physics::pi;
  RenderMesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int column = 0; column < columns; ++column)
    {
      const double polar = pi * ring / rings, around = 2 * pi * column / columns;
      const std::array<double, 3> n{ std::cos(polar), std::sin(polar) * std::cos(around),
                                     std::sin(polar) * std::sin(around) };
      mesh.normals.push_back({ static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2]) });
      auto& vertex = mesh.vertices.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        vertex[i] = static_cast<float>(ball.centre[i] + ball.radius * n[i]);
      const int next = ring * columns + (column + 1) % columns, here = ring * columns + column;
      if (ring < rings)
      {
        mesh.triangles.push_back({ here, here + columns, next });
        mesh.triangles.push_back({ next, here + columns, next + columns });
      }
    }
  mesh.colours.assign(mesh.vertices.size(), ball.colour);
  return mesh;
}

std::vector<RenderMesh> meshes_of(const RenderScene& scene)
{
  std::vector<RenderMesh> meshes = scene.meshes;
  std::transform(scene.balls.begin(), scene.balls.end(), std::back_inserter(meshes), mesh_of);
  // viewers would draw a mesh without normals as flat triangles
  for (RenderMesh& mesh : meshes)
    if (mesh.normals.empty())
      mesh.normals = normals_of(mesh);
  return meshes;
}

Json primitive_of(Glb& glb, RenderMesh mesh)
{
  Json attributes{ { "POSITION", glb.add(turned(mesh.vertices)) }, { "NORMAL", glb.add(turned(mesh.normals)) } };
  // Colours at the vertices of glTF are linear, not sRGB.
  for (auto& colour : mesh.colours)
    for (float& channel : colour)
      channel = std::pow(channel, 2.2F);
  attributes["COLOR_0"] = glb.add(mesh.colours);
  return { { "attributes", attributes },
           { "indices", glb.add(mesh.triangles) },
           { "material", 0 },
           { "targets", Json::array() } };
}

std::vector<std::string> chosen(const GltfOptions& options, const Model& model)
{
  const auto& all = options.expressions ? model.expressions : model.action_units;
  if (all.empty())
    throw Error(options.source.path + (options.expressions ? ": has no expressions" : ": has no action units") +
                ", which are the morph targets" +
                (options.expressions || model.expressions.empty() ? "" : "; it has expressions: give --expressions"));
  if (!options.only.empty())
    return options.only;
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Model::Expression& pose : all)
    names.push_back(pose.name);
  return names;
}

void write_gltf(const GltfOptions& options)
{
  const std::string what = "the path of a file .glb";
  if (std::filesystem::path(options.file).extension() != ".glb")
    throw WrongUsage("--output: found '" + options.file + "'; must be " + what);
  check_output(options.file, what);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  const std::vector<std::string> names = chosen(options, *model);
  std::vector<Controls> poses;
  poses.reserve(names.size());
  for (const std::string& name : names)
    poses.push_back(options.expressions ? expression_controls(*model, name)
                                        : action_unit_controls(*model, { { name, 1.0 } }));
  PosedFace face(model, options.solver);
  const FaceAppearance appearance(*model, face.rest());
  const std::vector<RenderMesh> rest = meshes_of(appearance.scene(face.rest(), rest_controls(*model)));
  Glb glb;
  Json primitives = Json::array();
  std::vector<int> no_motion(rest.size(), -1);  // accessor of as many zeros as each mesh has vertices
  for (const RenderMesh& mesh : rest)
    primitives.push_back(primitive_of(glb, mesh));

  Progress progress;
  for (std::size_t p = 0; p < poses.size(); ++p)
  {
    const auto watch = [&](double done) { progress.update("shaping", (double(p) + done) / double(poses.size())); };
    std::vector<RenderMesh> now;
    try
    {
      const SkinState& skin = face.take(poses[p], options.seconds, watch);
      now = meshes_of(appearance.scene(skin, face.controls()));
    }
    catch (const Unstable& error)
    {
      throw Error(names[p] + ": " + error.what());
    }
    for (std::size_t m = 0; m < rest.size(); ++m)
    {
      // A mesh that does not move in a target gets an accessor of zeros, which the mesh's other targets without motion
      // share.
      const auto moved = [&](const Points& from, const Points& to, int& zeros)
      {
        if (from != to)
          return glb.add(turned(difference(to, from)));
        if (zeros < 0)
          zeros = glb.add(Points(from.size()));
        return zeros;
      };
      primitives[m]["targets"].push_back({ { "POSITION", moved(rest[m].vertices, now[m].vertices, no_motion[m]) },
                                           { "NORMAL", moved(rest[m].normals, now[m].normals, no_motion[m]) } });
    }
  }
  progress.clear();
  write_text(options.file, glb.bytes(primitives, names));
  fmt::print("{}: {} vertices of skin, {} morph targets\n", options.file, face.rest().vertices.size(), names.size());
}

}  // namespace

void add_gltf_command(CLI::App& app)
{
  const auto options = std::make_shared<GltfOptions>();
  CLI::App* command = app.add_subcommand(
      "gltf", "write the face at rest as binary glTF, with its action units or expressions as morph targets");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("-o,--output", options->file, "file to write (.glb)")->required();
  command->add_flag("--expressions", options->expressions, "expressions as morph targets, instead of action units");
  command->add_option("--only", options->only, "those to take: NAME,NAME,... (all)")->delimiter(',');
  add_positive(*command, "--seconds", options->seconds, "simulated seconds from rest to a morph target (0.4)");
  add_solver_options(*command, options->solver);
  add_scene_options(*command, options->source);
  command->callback([options] { write_gltf(*options); });
}

}  // namespace frontalis
