#include "model/model_layout.hpp"

#include "frontalis/model/main_parts.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

constexpr std::uint8_t vtk_voxel = 11;

void write_geometry(Hdf5File& file, const Model& model)
{
  const auto voxels = static_cast<std::int64_t>(model.voxels.size());
  file.write("/VTKHDF/NumberOfPoints", std::vector<std::int64_t>{ static_cast<std::int64_t>(model.nodes.size()) });
  file.write("/VTKHDF/NumberOfCells", std::vector<std::int64_t>{ voxels });
  file.write("/VTKHDF/NumberOfConnectivityIds", std::vector<std::int64_t>{ 8 * voxels });

  std::vector<std::array<float, 3>> points(model.nodes.size());
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    const auto rest = rest_position(model, n);
    std::copy(rest.begin(), rest.end(), points[n].begin());
  }
  file.write("/VTKHDF/Points", points);

  std::vector<std::int64_t> connectivity, offsets{ 0 };
  connectivity.reserve(8 * model.voxels.size());
  for (const auto& corners : model.voxel_nodes)
  {
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  file.write("/VTKHDF/Connectivity", connectivity);
  file.write("/VTKHDF/Offsets", offsets);
  file.write("/VTKHDF/Types", std::vector<std::uint8_t>(model.voxels.size(), vtk_voxel));
}

void write_cell_data(Hdf5File& file, const Model& model)
{
  const std::size_t voxels = model.voxels.size();
  const MainParts parts(model);
  std::vector<std::int32_t> muscle(voxels, -1);
  std::vector<std::array<float, 3>> fibre(voxels, { { 0, 0, 0 } });
  std::vector<float> muscle_weight(voxels, 0);
  for (std::size_t e = 0; e < voxels; ++e)
  {
    const auto f = parts.fibres[e];
    if (f < 0)
      continue;
    muscle_weight[e] = model.fibre_weight[f];
    muscle[e] = model.fibre_muscle[f];
    fibre[e] = model.fibre_direction[f];
  }
  file.write("/VTKHDF/CellData/material", parts.material);
  file.write("/VTKHDF/CellData/fill", model.fill);
  file.write("/VTKHDF/CellData/muscle", muscle);
  file.write("/VTKHDF/CellData/muscle_weight", muscle_weight);
  file.write("/VTKHDF/CellData/fibre", fibre);
}

void write_point_data(Hdf5File& file, const Model& model)
{
  // `constraint`: 0 free, 1 rigid, 2 sliding, 3 prescribed, 4 attached. `held_by`: index of the constraint that
  // restricts the node; for a prescribed node, the number of constraints plus the index of the load; -1: none.
  std::vector<std::uint8_t> constraint(model.nodes.size(), 0);
  std::vector<std::int32_t> held_by(model.nodes.size(), -1);
  std::vector<float> distance(model.nodes.size(), 0);
  const auto hold = [&](std::int32_t node, std::uint8_t how, std::int32_t by)
  {
    constraint[node] = how;
    held_by[node] = by;
  };
  for (const SlidingNode& node : model.sliding)
  {
    hold(node.node, 2, node.constraint);
    distance[node.node] = static_cast<float>(node.distance);
  }
  for (const AttachedNode& node : model.attached)
    hold(node.node, 4, node.constraint);
  for (const PrescribedNode& node : model.prescribed)
    hold(node.node, 3, static_cast<std::int32_t>(model.constraints.size()) + node.load);
  for (const RigidNode& node : model.rigid)
    hold(node.node, 1, node.constraint);
  file.write("/VTKHDF/PointData/constraint", constraint);
  file.write("/VTKHDF/PointData/held_by", held_by);
  file.write("/VTKHDF/PointData/sliding_distance", distance);
}

}  // namespace

void write_vtk_arrays(Hdf5File& file, const Model& model)
{
  file.make_group("/VTKHDF");
  file.write_attribute("/VTKHDF", "Version", std::vector<std::int64_t>{ 1, 0 });
  file.write_attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
  write_geometry(file, model);
  write_cell_data(file, model);
  write_point_data(file, model);
}

}  // namespace frontalis
