#include "frontalis/error.hpp"
#include "bake/mesh/surface.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <fmt/format.h>

#include <filesystem>

namespace frontalis
{
namespace
{

void append(const aiMesh& part, const aiMatrix4x4& transform, double unit, TriangleMesh& mesh)
{
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v)
  {
    const aiVector3D p = transform * part.mVertices[v];
    mesh.vertices.push_back(
        { unit * static_cast<double>(p.x), unit * static_cast<double>(p.y), unit * static_cast<double>(p.z) });
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f)
  {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3)
      continue;
    mesh.triangles.push_back({ base + static_cast<std::int32_t>(face.mIndices[0]),
                               base + static_cast<std::int32_t>(face.mIndices[1]),
                               base + static_cast<std::int32_t>(face.mIndices[2]) });
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

}  // namespace

TriangleMesh import_mesh(const std::string& file, double unit)
{
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    throw Error("mesh file " + file + ": there is no such file");
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate | aiProcess_SortByPType);
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
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!to_vector(mesh.vertices[v]).allFinite())
      throw Error(
          fmt::format("mesh file {}: vertex {} is not a number or infinite; every coordinate must be finite", file, v));
  return mesh;
}

}  // namespace frontalis
