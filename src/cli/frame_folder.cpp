#include "cli/frame_folder.hpp"

#include "cli/reactions.hpp"
#include "cli/vtk_file.hpp"

#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <array>
#include <cstdint>
#include <utility>

namespace frontalis
{
namespace
{

std::string ply_of(const SkinState& skin, const std::vector<std::array<std::int32_t, 3>>& triangles, double time)
{
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment face frame, metres, time {:.6f} s\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      time, skin.vertices.size(), skin.line_height.empty() ? "" : "property float line_height\n", triangles.size());
  bytes.reserve(bytes.size() + 24 * skin.vertices.size() + 13 * triangles.size());
  for (std::size_t v = 0; v < skin.vertices.size(); ++v)
  {
    append_bytes(bytes, skin.vertices[v]);
    append_bytes(bytes, skin.normals[v]);
    if (!skin.line_height.empty())
      append_bytes(bytes, std::array<float, 1>{ { skin.line_height[v] } });
  }
  for (const std::array<std::int32_t, 3>& triangle : triangles)
  {
    bytes += '\3';
    append_bytes(bytes, triangle);
  }
  return bytes;
}

using Triangles = std::vector<std::array<std::int32_t, 3>>;

std::string vtp_of(const SkinState& skin, const SkinState& rest, const Triangles& triangles)
{
  std::vector<std::array<float, 3>> displacements(skin.vertices);
  for (std::size_t v = 0; v < displacements.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis)
      displacements[v][axis] -= rest.vertices[v][axis];
  VtkFile file("PolyData",
               fmt::format("NumberOfPoints=\"{}\" NumberOfPolys=\"{}\"", skin.vertices.size(), triangles.size()));
  file.begin("PointData", "Normals=\"normals\" Vectors=\"displacement\"");
  file.add("normals", skin.normals);
  file.add("displacement", displacements);
  if (!skin.line_height.empty())
    file.add("line_height", skin.line_height);
  file.begin("Points");
  file.add("points", skin.vertices);
  file.begin("Polys");
  file.add_corners(triangles);
  return file.text();
}

template <class Part>
std::vector<std::string> names_of(const std::vector<Part>& parts)
{
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const Part& part : parts)
    names.push_back(part.name);
  return names;
}

std::string vtu_of(const TissueState& tissue, const MainParts& parts, const Model& model)
{
  constexpr std::uint8_t hexahedron = 12;
  constexpr std::array<std::size_t, 8> corner_of_hexahedron{ { 0, 1, 3, 2, 4, 5, 7, 6 } };
  const std::size_t voxels = model.voxels.size();
  std::vector<std::array<std::int32_t, 8>> corners(voxels);
  std::vector<std::int32_t> muscle(voxels, -1);
  for (std::size_t e = 0; e < voxels; ++e)
  {
    for (std::size_t b = 0; b < 8; ++b)
      corners[e][b] = model.voxel_nodes[e][corner_of_hexahedron[b]];
    if (parts.fibres[e] >= 0)
      muscle[e] = model.fibre_muscle[static_cast<std::size_t>(parts.fibres[e])];
  }
  VtkFile file("UnstructuredGrid",
               fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", tissue.place.size(), voxels));
  file.add_names("materials", names_of(model.materials));
  file.add_names("muscles", names_of(model.muscles));
  file.begin("PointData", "Vectors=\"displacement\"");
  file.add("displacement", tissue.displacement);
  file.begin("CellData", "Scalars=\"von_mises_stress\"");
  file.add("von_mises_stress", tissue.von_mises);
  file.add("cauchy_stress", tissue.stress);
  file.add("green_lagrange_strain", tissue.strain);
  file.add("volume_ratio", tissue.volume_ratio);
  file.add("fibre_stretch", tissue.fibre_stretch);
  file.add("material", parts.material);
  file.add("muscle", muscle);
  file.add("fill", model.fill);
  file.begin("Points");
  file.add("points", tissue.place);
  file.begin("Cells");
  file.add_corners(corners);
  file.add("types", std::vector<std::uint8_t>(voxels, hexahedron));
  return file.text();
}

// The file that lists frames with their times for ParaView.
std::string collection_of(const std::string& entries)
{
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n" + entries +
         "</Collection>\n</VTKFile>\n";
}

}  // namespace

FrameFolder::FrameFolder(std::string path, const Model& model, FrameFiles files)
    : path_(std::move(path)),
      model_(model),
      files_(files),
      table_("frame,time_s,landmark,x_m,y_m,z_m,forward_mm,left_mm,up_mm\n")
{
  if (files_.vtu)
    tissue_.emplace(model);
  make_folder(path_);
  remove_files(path_,
               R"((skin_[0-9]{4,}\.(ply|vtp)|tissue_[0-9]{4,}\.vtu|(skin|tissue)\.pvd|landmarks\.csv|reactions\.csv)"
               R"(|run\.json)(\.partial(-[0-9]+)?)?)");
}

void FrameFolder::add(double time, const SkinState& skin, const SkinState& rest, const std::vector<BodyFrame>& bodies,
                      const Solver& solver)
{
  const auto write_vtk = [&](const std::string& name, const std::string& text, std::string& entries)
  {
    write_text(path_ + "/" + name, text);
    entries += fmt::format("<DataSet timestep=\"{:.6f}\" file=\"{}\"/>\n", time, name);
  };
  write_text(fmt::format("{}/skin_{:04}.ply", path_, frames_), ply_of(skin, model_.skin.triangles, time));
  if (files_.vtp)
    write_vtk(fmt::format("skin_{:04}.vtp", frames_), vtp_of(skin, rest, model_.skin.triangles), skins_);
  if (files_.vtu)
  {
    TissueState state;
    tissue_->read(solver, state);
    write_vtk(fmt::format("tissue_{:04}.vtu", frames_), vtu_of(state, tissue_->parts(), model_), tissues_);
  }
  for (std::size_t l = 0; l < skin.landmarks.size(); ++l)
  {
    const std::array<float, 3>& now = skin.landmarks[l];
    const std::array<float, 3>& then = rest.landmarks[l];
    table_ += fmt::format("{},{:.6f},{},{:.9g},{:.9g},{:.9g},{:.6f},{:.6f},{:.6f}\n", frames_, time,
                          model_.landmarks[l], now[0], now[1], now[2], 1e3 * (now[0] - then[0]),
                          1e3 * (now[1] - then[1]), 1e3 * (now[2] - then[2]));
  }
  reactions_ += reaction_rows(model_, frames_, time, bodies);
  ++frames_;
}

void FrameFolder::finish(const std::string& summary)
{
  write_text(path_ + "/landmarks.csv", table_);
  if (!reactions_.empty())
    write_text(path_ + "/reactions.csv", reaction_heading + reactions_);
  if (files_.vtp)
    write_text(path_ + "/skin.pvd", collection_of(skins_));
  if (files_.vtu)
    write_text(path_ + "/tissue.pvd", collection_of(tissues_));
  write_text(path_ + "/run.json", summary);
}

}  // namespace frontalis
