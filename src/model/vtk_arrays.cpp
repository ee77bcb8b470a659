#include "model/vtk_arrays.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

constexpr std::uint8_t vtk_voxel = 11;

void write_geometry(Hdf5File& file, const Model& model)
{
  const std::size_t nodes = model.nodes.size();
  const std::size_t voxels = model.voxels.size();
  const auto count = [&file](const std::string& name, std::size_t number)
  {
    const std::int64_t value = static_cast<std::int64_t>(number);
    file.write("/VTKHDF/" + name, &value, 1, 1);
  };
  count("NumberOfPoints", nodes);
  count("NumberOfCells", voxels);
  count("NumberOfConnectivityIds", 8 * voxels);

  std::vector<float> points(3 * nodes);
  for (std::size_t n = 0; n < nodes; ++n)
  {
    for (std::size_t a = 0; a < 3; ++a)
      points[3 * n + a] = static_cast<float>(model.nodes[n][a] * model.spacing[a]);
  }
  file.write("/VTKHDF/Points", points.data(), nodes, 3);

  std::vector<std::int64_t> connectivity(8 * voxels), offsets(voxels + 1);
  for (std::size_t e = 0; e < voxels; ++e)
  {
    offsets[e] = static_cast<std::int64_t>(8 * e);
    for (std::size_t b = 0; b < 8; ++b)
      connectivity[8 * e + b] = model.voxel_nodes[e][b];
  }
  offsets[voxels] = static_cast<std::int64_t>(8 * voxels);
  file.write("/VTKHDF/Connectivity", connectivity.data(), connectivity.size(), 1);
  file.write("/VTKHDF/Offsets", offsets.data(), offsets.size(), 1);
  const std::vector<std::uint8_t> types(voxels, vtk_voxel);
  file.write("/VTKHDF/Types", types.data(), types.size(), 1);
}

void write_cell_data(Hdf5File& file, const Model& model)
{
  const std::size_t voxels = model.voxels.size();
  std::vector<std::int32_t> material(voxels, -1), muscle(voxels, -1);
  std::vector<float> fibre(3 * voxels, 0.f), muscle_weight(voxels, 0.f);
  for (std::size_t e = 0; e < voxels; ++e)
  {
    // the material of the largest proportion, and the muscle of the largest weight
    float largest = 0;
    for (auto m = static_cast<std::size_t>(model.mixture_begin[e]);
         m < static_cast<std::size_t>(model.mixture_begin[e + 1]); ++m)
    {
      if (model.mixture_proportion[m] > largest)
      {
        largest = model.mixture_proportion[m];
        material[e] = model.mixture_material[m];
      }
    }
    for (auto m = static_cast<std::size_t>(model.fibre_begin[e]);
         m < static_cast<std::size_t>(model.fibre_begin[e + 1]); ++m)
    {
      if (model.fibre_weight[m] > muscle_weight[e])
      {
        muscle_weight[e] = model.fibre_weight[m];
        muscle[e] = model.fibre_muscle[m];
        for (std::size_t a = 0; a < 3; ++a)
          fibre[3 * e + a] = model.fibre_direction[m][a];
      }
    }
  }
  file.write("/VTKHDF/CellData/material", material.data(), voxels, 1);
  file.write("/VTKHDF/CellData/fill", model.fill.data(), voxels, 1);
  file.write("/VTKHDF/CellData/muscle", muscle.data(), voxels, 1);
  file.write("/VTKHDF/CellData/muscle_weight", muscle_weight.data(), voxels, 1);
  file.write("/VTKHDF/CellData/fibre", fibre.data(), voxels, 3);
}

void write_point_data(Hdf5File& file, const Model& model)
{
  // constraint: 0 free, 1 rigid, 2 sliding, 3 prescribed; held_by: index of a constraint, loads counted behind the
  // constraints; -1: none
  std::vector<std::uint8_t> constraint(model.nodes.size(), 0);
  std::vector<std::int32_t> held_by(model.nodes.size(), -1);
  std::vector<float> distance(model.nodes.size(), 0.f);
  for (const SlidingNode& node : model.sliding)
  {
    constraint[static_cast<std::size_t>(node.node)] = 2;
    distance[static_cast<std::size_t>(node.node)] = static_cast<float>(node.distance);
    held_by[static_cast<std::size_t>(node.node)] = node.constraint;
  }
  for (const PrescribedNode& node : model.prescribed)
  {
    constraint[static_cast<std::size_t>(node.node)] = 3;
    held_by[static_cast<std::size_t>(node.node)] = static_cast<std::int32_t>(model.constraints.size()) + node.load;
  }
  for (const RigidNode& node : model.rigid)
  {
    constraint[static_cast<std::size_t>(node.node)] = 1;
    held_by[static_cast<std::size_t>(node.node)] = node.constraint;
  }
  file.write("/VTKHDF/PointData/constraint", constraint.data(), constraint.size(), 1);
  file.write("/VTKHDF/PointData/held_by", held_by.data(), held_by.size(), 1);
  file.write("/VTKHDF/PointData/sliding_distance", distance.data(), distance.size(), 1);
}

}  // namespace

void write_vtk_arrays(Hdf5File& file, const Model& model)
{
  file.make_group("/VTKHDF");
  file.write_attribute("/VTKHDF", "Version", std::vector<std::int64_t>{ 1, 0 });
  file.write_attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
  write_geometry(file, model);
  file.make_group("/VTKHDF/CellData");
  write_cell_data(file, model);
  file.make_group("/VTKHDF/PointData");
  write_point_data(file, model);
}

}  // namespace frontalis
