#include "solver/shell/shell_forces.hpp"

#include "frontalis/physics/trilinear.hpp"
#include "solver/shell/shell_energy.hpp"

#include <algorithm>
#include <numeric>

namespace frontalis
{
namespace
{

// Writes a triangle's values to a lane. A lane that is to be empty gets a triangle without stiffness.
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
  block.inverse_area[lane] = static_cast<Real>(rest.inverse_area);
  block.shear[lane] = there * static_cast<Real>(rest.shear);
  block.dilatation[lane] = there * static_cast<Real>(rest.dilatation);
  for (std::size_t i = 0; i < 6; ++i)
  {
    block.bending[i][lane] = there * static_cast<Real>(rest.bending[i]);
  }
}

// The thread's part of `count` items.
std::pair<std::int32_t, std::int32_t> share_of(std::size_t count, const NodeShare& share)
{
  return { static_cast<std::int32_t>(count * share.thread / share.threads),
           static_cast<std::int32_t>(count * (share.thread + 1) / share.threads) };
}

}  // namespace

template <class Real>
ShellForces<Real>::ShellForces(const Model& model, const ShellKernels<Real>& kernels)
    : model_(model), mesh_(model), kernels_(kernels)
{
  const Binding& binding = mesh_.binding;
  if (binding.voxel.empty())
    return;
  plane_vertices_.assign(static_cast<std::size_t>(model.size[2]) + 2, 0);
  std::vector<typename Sums::Terms> of_node(model.nodes.size());
  for (std::size_t v = 0; v < binding.voxel.size(); ++v)
  {
    const auto& at = binding.coordinates[v];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    for (std::size_t b = 0; b < 8; ++b)
      of_node[model.voxel_nodes[binding.voxel[v]][b]].push_back(
          { static_cast<std::int32_t>(v), static_cast<Real>(weight[b]) });
    ++plane_vertices_[model.voxels[binding.voxel[v]][2] + 1];
  }
  std::partial_sum(plane_vertices_.begin(), plane_vertices_.end(), plane_vertices_.begin());
  for (std::size_t n = 0; n < of_node.size(); ++n)
    if (!of_node[n].empty())
      nodes_.push_back(static_cast<std::int32_t>(n));
  of_node.erase(std::remove_if(of_node.begin(), of_node.end(), [](const auto& terms) { return terms.empty(); }),
                of_node.end());
  on_node_ = Sums(of_node);
  add_blocks();
  u_.resize(vertices_.size() * Vertices::width);
}

template <class Real>
std::int32_t ShellForces<Real>::place_of(std::size_t i) const
{
  const auto lane = static_cast<int>(i % Block::width);
  return static_cast<std::int32_t>(i) - lane + kernels_.place_of_lane(lane);
}

template <class Real>
void ShellForces<Real>::add_blocks()
{
  constexpr std::size_t width = Block::width;
  const Binding& binding = mesh_.binding;
  vertices_.resize((binding.voxel.size() + width - 1) / width);
  for (std::size_t p = 0; p < vertices_.size() * width; ++p)
  {
    const std::size_t lane = p % width, v = p < binding.voxel.size() ? p : p - lane;
    Vertices& block = vertices_[p / width];
    for (std::size_t two = 0; two < 4; ++two)
      block.node[two][lane] = model_.voxel_nodes[binding.voxel[v]][2 * two];
    for (std::size_t axis = 0; axis < 3; ++axis)
      block.coordinates[axis][lane] = Real(binding.coordinates[v][axis]);
  }
  blocks_.resize((mesh_.triangles.size() + width - 1) / width);
  forces_.resize(blocks_.size() * 6 * width);
  std::vector<typename Sums::Terms> of_vertex(binding.voxel.size());
  for (std::size_t t = 0; t < blocks_.size() * width; ++t)
  {
    const bool empty = t >= mesh_.triangles.size();
    const ShellMesh::Triangle& triangle = mesh_.triangles[empty ? 0 : t];
    set_lane(blocks_[t / width], t % width, triangle, empty);
    for (std::size_t i = 0; i < 6; ++i)
    {
      blocks_[t / width].vertex[i][t % width] = place_of(triangle.vertex[i]);
      if (!empty && (i < 3 || triangle.has_beyond(i - 3)))
        of_vertex[triangle.vertex[i]].push_back({ place_of((t / width * 6 + i) * width + t % width), Real(1) });
    }
  }
  on_vertex_ = Sums(of_vertex);
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
  list.add(effect, "nodes", nodes_);
  for (const Sums* const sums : { &on_vertex_, &on_node_ })
    if (!sums->terms.empty())
    {
      list.add(effect, "sums", sums->begin);
      list.add(effect, "sums", sums->terms);
    }
  list.add(effect, "forces", u_);
  list.add(effect, "forces", forces_);
}

template <class Real>
void ShellForces<Real>::prepare_step(const NodeShare& share, const Real* const u[3])
{
  if (share.thread == 0)
    work_.resize(static_cast<std::size_t>(share.threads));
  const auto [first, last] = share_of(vertices_.size(), share);
  kernels_.place(vertices_.data(), u, u_.data(), first, last);
}

template <class Real>
void ShellForces<Real>::before_step(const NodeShare& share, const Real* const /*u*/[3], const ConstraintStep& /*step*/)
{
  const auto [first, last] = share_of(blocks_.size(), share);
  kernels_.forces(blocks_.data(), u_.data(), forces_.data(), first, last);
}

template <class Real>
void ShellForces<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  Work& work = work_[share.thread];
  work.on_vertex.resize(mesh_.binding.voxel.size());
  work.on_node.resize(nodes_.size());
  kernels_.sum(on_vertex_, forces_.data(), work.on_vertex.data(), plane_vertices_[std::max(share.first_plane - 1, 0)],
               plane_vertices_[share.end_plane]);
  const auto place = [&](std::int32_t node)
  { return static_cast<std::int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin()); };
  const auto begin = place(share.first_node), end = place(share.end_node);
  kernels_.sum(on_node_, work.on_vertex.data(), work.on_node.data(), begin, end);
  const ForceSink<Real> to = sink;  // a copy, so that the compiler keeps its members in registers
  for (auto n = begin; n < end; ++n)
  {
    const auto& force = work.on_node[n].x;
    to(nodes_[n], std::array<Real, 3>{ { force[0], force[1], force[2] } });
  }
}

template <class Real>
void ShellForces<Real>::add_energies(const Real* const u[3], const std::vector<RigidTransform>& /*bones*/,
                                     bool /*open*/, std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger)
{
  add_shell_energies(model_, mesh_, u, forces, ledger);
}

template class ShellForces<float>;
template class ShellForces<double>;

}  // namespace frontalis
