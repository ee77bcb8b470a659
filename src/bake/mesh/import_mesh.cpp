#include "bake/mesh/surface.hpp"

#include "bake/messages.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace frontalis
{
namespace
{

void append(const aiMesh& part, const aiMatrix4x4& transform, double unit, TriangleMesh& mesh)
{
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  // The product with a matrix would spread a coordinate that is not a number to the others, which say where it is.
  const bool stays = transform.IsIdentity();
  for (unsigned v = 0; v < part.mNumVertices; ++v)
  {
    const aiVector3D p = stays ? part.mVertices[v] : transform * part.mVertices[v];
    mesh.vertices.push_back(to_array(unit * Vector3d(p.x, p.y, p.z)));
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f)
    if (const aiFace& face = part.mFaces[f]; face.mNumIndices == 3)
    {
      const auto corner = [&](unsigned c) { return base + static_cast<std::int32_t>(face.mIndices[c]); };
      mesh.triangles.push_back({ corner(0), corner(1), corner(2) });
    }
}

void append(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, double unit, TriangleMesh& mesh)
{
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m)
    append(*scene.mMeshes[node.mMeshes[m]], transform, unit, mesh);
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    append(scene, *node.mChildren[c], transform, unit, mesh);
}

std::string in_lower_case(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// What is wrong with an STL file that ends too early or too late, or an empty text.
std::string cut_off_stl(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 84> header{};  // a text of 80 bytes, then the number of triangles, the lowest byte first
  const bool whole = !stream.read(header.data(), header.size()).fail();
  double triangles = 0;
  for (std::size_t byte = 84; byte-- > 80;)
    triangles = 256 * triangles + static_cast<unsigned char>(header[byte]);
  stream.clear();
  stream.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(stream.tellg());
  const double bytes = static_cast<double>(size), expected = 84 + 50 * triangles;
  const std::string word(header.data(), 5);
  if (bytes != expected && word != "solid" && in_lower_case(word) == "solid")
    return "it is a text with capitals, which importers of STL files cannot read; export it as a binary file";
  // The text at the start of a binary file may be that of a text file.
  if (word == "solid" && bytes != expected)
  {
    constexpr std::streamoff end = 1000;
    stream.seekg(std::max<std::streamoff>(0, size - end));
    const std::string last{ std::istreambuf_iterator<char>(stream), {} };
    return in_lower_case(last).find("endsolid") == std::string::npos
               ? "it does not end with 'endsolid': it was cut off; copy or export it again"
               : "";
  }
  if (!whole || bytes == expected)
    return {};
  return fmt::format(
      "its header announces {:.0f} triangles, as STL {:.0f} bytes, but it has {:.0f}: it was {}, or is no STL file; "
      "copy or export it again",
      triangles, expected, bytes, bytes < expected ? "cut off" : "extended");
}

/// What is wrong with a PLY file of text that ends too early, or an empty text.
std::string cut_off_ply(const std::string& file)
{
  std::ifstream stream(file);
  double announced = 0, found = 0;
  bool of_text = false, in_header = true;
  for (std::string line, word; std::getline(stream, line);)
  {
    std::istringstream words(line);
    if (!in_header && !of_text)
      return {};
    if (!(words >> word))
      continue;
    found += in_header ? 0 : 1;
    if (double count = 0; in_header && word == "element" && words >> word >> count)
      announced += count;
    of_text = of_text || (in_header && word == "format" && words >> word && word == "ascii");
    in_header = in_header && word != "end_header";
  }
  if (found >= announced)
    return {};
  return fmt::format(
      "its header announces {:.0f} vertices, faces and so on, but it has {:.0f} lines of them: it was cut off, or "
      "has several on one line; copy or export it again",
      announced, found);
}

/// What is wrong with vertices of text, or an empty text. Importers take 10,5 for 10, and leave out vertices that they
/// cannot read, so that faces get the corners of others. `vertex`: word before the coordinates in a line.
std::string unreadable_vertex(const std::string& file, const std::string& vertex)
{
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  std::ifstream stream(file);
  int number = 0;
  for (std::string line; std::getline(stream, line);)
  {
    ++number;
    line.erase(std::min({ line.size(), line.find('\r'), line.find('#') }));
    const std::size_t begin = line.find_first_not_of(" \t");
    const std::size_t end = begin == std::string::npos ? begin : begin + vertex.size();
    if (begin == std::string::npos || line.compare(begin, vertex.size(), vertex) != 0 ||
        (end < line.size() && std::isspace(static_cast<unsigned char>(line[end])) == 0) || line.back() == '\\')
      continue;
    if (line.find(',') != std::string::npos)
      return fmt::format(
          "line {} has numbers with a comma ('{}'); they must have a decimal point, as in 10.5: export it "
          "again, or replace the commas",
          number, line);
    const char* at = line.c_str() + end;
    for (int axis = 0; axis < 3; ++axis)
    {
      char* after = nullptr;
      strtod_l(at, &after, plain);  // numbers have points whatever the locale of the program
      if (after == at)
        return fmt::format("line {} must have three coordinates ('{}'): export it again, or correct the line", number,
                           line);
      at = after;
    }
  }
  return {};
}

/// Says which other format a file named .obj has, by its first bytes, or returns an empty text.
std::string format_of_named_obj(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 84> header{};
  stream.read(header.data(), header.size());
  const std::string start(header.data(), static_cast<std::size_t>(stream.gcount()));
  if (start.empty())
    return "is empty; copy or export it again";
  const auto begins = [&](const char* with) { return start.rfind(with, 0) == 0; };
  const bool wide = begins("\xff\xfe") || begins("\xfe\xff");  // UTF-16, which the importer reads
  const char* const format = begins("ply")                                    ? "a PLY"
                             : begins("solid")                                ? "an STL"
                             : !wide && start.find('\0') != std::string::npos ? "a binary"
                                                                              : "";
  if (begins("\x1f\x8b"))
    return "is compressed; unpack it first";
  return *format == '\0' ? "" : fmt::format("is {} file and no OBJ file; give it the name of its format", format);
}

/// Throws Error if a face has no corners or one that is not there, which the importers of PLY and OFF do not check.
void check_faces(const aiScene& scene, const std::string& file)
{
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
    {
      const aiFace& face = scene.mMeshes[m]->mFaces[f];
      const unsigned vertices = scene.mMeshes[m]->mNumVertices;
      if (face.mNumIndices == 0 || face.mIndices == nullptr)
        throw failure(
            "mesh file {}: face {} of {} has no corners: it was cut off or is damaged; copy or export it again", file,
            f + 1, scene.mMeshes[m]->mNumFaces);
      if (const unsigned last = *std::max_element(face.mIndices, face.mIndices + face.mNumIndices); last >= vertices)
        throw failure(
            "mesh file {}: face {} has corner {}, but there are {} vertices, counted from 0: it was cut off or is "
            "damaged; copy or export it again",
            file, f + 1, static_cast<std::int32_t>(last), vertices);
    }
}

}  // namespace

TriangleMesh import_mesh(const std::string& file, double unit)
{
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    throw Error("mesh file " + file + ": there is no such file");
  std::array<char, 3> start{};
  std::ifstream(file, std::ios::binary).read(start.data(), start.size());
  if (std::string(start.data(), start.size()) == "\xef\xbb\xbf")
    throw Error("mesh file " + file + ": begins with a byte-order mark; save it as text without one");
  const std::string extension = in_lower_case(std::filesystem::path(file).extension().string());
  std::string fault = extension == ".ply"   ? cut_off_ply(file)
                      : extension == ".stl" ? cut_off_stl(file)
                      : extension == ".obj" ? format_of_named_obj(file)
                                            : "";
  if (fault.empty() && (extension == ".obj" || extension == ".stl"))
    fault = unreadable_vertex(file, extension == ".obj" ? "v" : "vertex");
  if (!fault.empty())
    throw Error("mesh file " + file + ": " + fault);
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file, 0);
  if (scene != nullptr)
  {
    check_faces(*scene, file);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
  }
  const std::string no_triangles = ": has no triangles; it must hold a surface, not points or lines";
  if (scene == nullptr && std::string(importer.GetErrorString()).find("No meshes remaining") != std::string::npos)
    throw Error("mesh file " + file + no_triangles);
  if (scene == nullptr)
    throw Error("mesh file " + file + ": cannot be read as a mesh (" + importer.GetErrorString() +
                "); it must hold triangles or quads, for example as OBJ, STL or PLY");
  TriangleMesh mesh;
  if (scene->mRootNode != nullptr)
    append(*scene, *scene->mRootNode, aiMatrix4x4(), unit, mesh);
  if (mesh.triangles.empty())
    throw Error("mesh file " + file + no_triangles);
  constexpr double farthest = 1000;  // [m]
  for (const Vector3& v : mesh.vertices)
  {
    const bool finite = to_vector(v).allFinite();
    if (!finite || to_vector(v).norm() > farthest)
      throw failure("mesh file {}: the vertex ({:g}, {:g}, {:g}) {}", file, v[0] / unit, v[1] / unit, v[2] / unit,
                    finite ? "is more than a kilometre from the origin; correct it, or check the file's unit"
                           : "is not finite; every coordinate must be finite");
  }
  return mesh;
}

}  // namespace frontalis
