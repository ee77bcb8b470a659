#include "solver/shell/shell_forces.hpp"

#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/skin/bound_points.hpp"

#include <algorithm>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Writes a triangle's numbers to a lane; a triangle of an empty lane has no stiffness.
template <class Real>
void set_lane(ShellBlock<Real>& block, std::size_t lane, const ShellMesh::Triangle& triangle, bool empty)
{
  const auto& rest = triangle.rest;
  const Real there = empty ? 0 : 1;
  for (std::size_t i = 0; i < 5; ++i)
  {
    block.from_corner[i][0][lane] = static_cast<Real>(rest.from_corner[i].x);
    block.from_corner[i][1][lane] = static_cast<Real>(rest.from_corner[i].y);
    block.from_corner[i][2][lane] = static_cast<Real>(rest.from_corner[i].z);
  }
  for (std::size_t i = 0; i < 3; ++i)
  {
    block.metric[i][lane] = static_cast<Real>(rest.metric[i]);
    block.height[i][lane] = static_cast<Real>(rest.height[i]);
  }
  block.area_twice[lane] = static_cast<Real>(rest.area_twice);
  block.shear[lane] = there * static_cast<Real>(rest.shear);
  block.dilatation[lane] = there * static_cast<Real>(rest.dilatation);
  for (std::size_t i = 0; i < 6; ++i)
  {
    block.bending[i][lane] = there * static_cast<Real>(rest.bending[i]);
    block.vertex[i][lane] = triangle.vertex[i];
  }
}

}  // namespace

template <class Real>
ShellForces<Real>::ShellForces(const Model& model, ShellKernel<Real> kernel) : mesh_(model), kernel_(kernel)
{
  const std::size_t count = mesh_.binding.voxel.size();
  if (count == 0)
    return;
  plane_vertices_.assign(static_cast<std::size_t>(model.size[2]) + 2, 0);
  std::vector<std::vector<Part>> parts(model.nodes.size());
  vertices_.reserve(count);
  for (std::size_t v = 0; v < count; ++v)
  {
    const auto& at = mesh_.binding.coordinates[v];
    const auto voxel = mesh_.binding.voxel[v];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    Vertex vertex{ model.voxel_nodes[voxel], {} };
    for (std::size_t b = 0; b < 8; ++b)
    {
      vertex.weight[b] = static_cast<Real>(weight[b]);
      parts[vertex.node[b]].push_back({ static_cast<std::int32_t>(v), vertex.weight[b] });
    }
    vertices_.push_back(vertex);
    ++plane_vertices_[model.voxels[voxel][2] + 1];
  }
  std::partial_sum(plane_vertices_.begin(), plane_vertices_.end(), plane_vertices_.begin());
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    if (parts[n].empty())
      continue;
    nodes_.push_back(static_cast<std::int32_t>(n));
    part_begin_.push_back(static_cast<std::int32_t>(parts_.size()));
    parts_.insert(parts_.end(), parts[n].begin(), parts[n].end());
  }
  part_begin_.push_back(static_cast<std::int32_t>(parts_.size()));
  add_blocks();
  for (auto& component : u_)
    component.assign(count, 0);
}

template <class Real>
void ShellForces<Real>::add_blocks()
{
  constexpr std::size_t width = Block::width;
  blocks_.resize((mesh_.triangles.size() + width - 1) / width);
  forces_.assign(blocks_.size() * 18 * width, 0);
  std::vector<std::vector<std::int32_t>> places(vertices_.size());
  for (std::size_t t = 0; t < blocks_.size() * width; ++t)
  {
    const bool empty = t >= mesh_.triangles.size();
    const ShellMesh::Triangle& triangle = mesh_.triangles[empty ? 0 : t];
    set_lane(blocks_[t / width], t % width, triangle, empty);
    for (std::size_t i = 0; i < 6 && !empty; ++i)
      if (i < 3 || triangle.has_beyond(i - 3))
        places[triangle.vertex[i]].push_back(static_cast<std::int32_t>((t / width * 18 + 3 * i) * width + t % width));
  }
  place_begin_.assign(1, 0);
  for (const auto& of_vertex : places)
  {
    place_.insert(place_.end(), of_vertex.begin(), of_vertex.end());
    place_begin_.push_back(static_cast<std::int32_t>(place_.size()));
  }
}

template <class Real>
void ShellForces<Real>::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::shell;
  list.add(effect, "triangles", mesh_.triangles);
  list.add(effect, "triangles", blocks_);
  list.add(effect, "vertices", mesh_.binding.voxel);
  list.add(effect, "vertices", mesh_.binding.coordinates);
  list.add(effect, "vertices", vertices_);
  list.add(effect, "vertices", plane_vertices_);
  list.add(effect, "vertices", place_begin_);
  list.add(effect, "vertices", place_);
  list.add(effect, "nodes", nodes_);
  list.add(effect, "nodes", part_begin_);
  list.add(effect, "nodes", parts_);
  for (const auto& component : u_)
    list.add(effect, "forces", component);
  list.add(effect, "forces", forces_);
}

template <class Real>
void ShellForces<Real>::prepare_step(const NodeShare& share, const Real* const u[3])
{
  if (share.thread == 0)
    vertex_force_.resize(static_cast<std::size_t>(share.threads));
  const std::size_t begin = vertices_.size() * share.thread / share.threads;
  const std::size_t end = vertices_.size() * (share.thread + 1) / share.threads;
  for (std::size_t v = begin; v < end; ++v)
  {
    const Vertex& vertex = vertices_[v];
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      Real sum = 0;
      for (std::size_t b = 0; b < 8; ++b)
        sum += vertex.weight[b] * u[axis][vertex.node[b]];
      u_[axis][v] = sum;
    }
  }
}

template <class Real>
void ShellForces<Real>::before_step(const NodeShare& share, const Real* const /*u*/[3], const ConstraintStep& /*step*/)
{
  const std::size_t begin = blocks_.size() * share.thread / share.threads;
  const std::size_t end = blocks_.size() * (share.thread + 1) / share.threads;
  kernel_({ blocks_.data(), { u_[0].data(), u_[1].data(), u_[2].data() }, forces_.data() },
          static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end));
}

template <class Real>
void ShellForces<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  constexpr std::size_t width = Block::width;
  std::vector<Force>& vertex_force = vertex_force_[share.thread];
  vertex_force.resize(vertices_.size());
  const auto last = plane_vertices_[share.end_plane];
  for (auto v = plane_vertices_[std::max(share.first_plane - 1, 0)]; v < last; ++v)
  {
    Force sum{};
    for (auto p = place_begin_[v]; p < place_begin_[v + 1]; ++p)
    {
      const Real* const force = forces_.data() + place_[p];
      sum[0] += force[0];
      sum[1] += force[width];
      sum[2] += force[2 * width];
    }
    vertex_force[v] = sum;
  }
  const auto first = std::lower_bound(nodes_.begin(), nodes_.end(), share.first_node) - nodes_.begin();
  for (auto n = static_cast<std::size_t>(first); n < nodes_.size() && nodes_[n] < share.end_node; ++n)
  {
    Force sum{};
    for (auto p = part_begin_[n]; p < part_begin_[n + 1]; ++p)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += parts_[p].weight * vertex_force[parts_[p].vertex][axis];
    sink(nodes_[n], { { double(sum[0]), double(sum[1]), double(sum[2]) } });
  }
}

template <class Real>
void ShellForces<Real>::add_energies(const Real* const u[3], const std::vector<RigidTransform>& /*bones*/,
                                     bool /*open*/, std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger)
{
  std::vector<Vector> moved(vertices_.size()), on_vertex(vertices_.size());
  for (std::size_t v = 0; v < moved.size(); ++v)
    for (std::size_t b = 0; b < 8; ++b)
    {
      const auto node = vertices_[v].node[b];
      moved[v] = moved[v] +
                 double(vertices_[v].weight[b]) * Vector{ double(u[0][node]), double(u[1][node]), double(u[2][node]) };
    }
  for (const ShellMesh::Triangle& triangle : mesh_.triangles)
  {
    Vector of_triangle[6];
    for (std::size_t i = 0; i < 6; ++i)
      of_triangle[i] = moved[triangle.vertex[i]];
    const auto now = physics::shell_forces(triangle.rest, of_triangle);
    ledger["shell"] += now.membrane + now.bending;
    for (std::size_t i = 0; i < 6; ++i)
      on_vertex[triangle.vertex[i]] = on_vertex[triangle.vertex[i]] + now.force[i];
  }
  for (std::size_t v = 0; v < on_vertex.size() && !forces.empty(); ++v)
    for (std::size_t b = 0; b < 8; ++b)
      add_vector(forces[vertices_[v].node[b]], double(vertices_[v].weight[b]) * on_vertex[v]);
}

template class ShellForces<float>;
template class ShellForces<double>;

}  // namespace frontalis
