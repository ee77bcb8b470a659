#include "cuda/bench/self_contact_blocks.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

constexpr std::int32_t side = 35;
constexpr double edge = 1e-3, way = -1.03e-3;

// Adds the upper or lower side of layer k of voxels to the contact surface, with vertices at the nodes and in the
// middle of each square.
void add_side(const Model& model, SelfContact& contact, std::int32_t k, bool upper)
{
  TriangleMesh& mesh = contact.surface;
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  const auto add = [&](double x, double y)
  {
    const Voxel at{ { std::min(static_cast<std::int32_t>(x), side - 1),
                      std::min(static_cast<std::int32_t>(y), side - 1), k } };
    const auto voxel =
        std::lower_bound(model.voxels.begin(), model.voxels.end(), at,
                         [](const Voxel& a, const Voxel& b)
                         { return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend()); });
    mesh.vertices.push_back({ { edge * x, edge * y, edge * (upper ? k + 1 : k) } });
    contact.binding.voxel.push_back(static_cast<std::int32_t>(voxel - model.voxels.begin()));
    contact.binding.coordinates.push_back(
        { { static_cast<float>(x - at[0]), static_cast<float>(y - at[1]), upper ? 1.0F : 0.0F } });
  };
  for (std::int32_t j = 0; j <= side; ++j)
    for (std::int32_t i = 0; i <= side; ++i)
      add(i, j);
  for (std::int32_t j = 0; j < side; ++j)
    for (std::int32_t i = 0; i < side; ++i)
    {
      const std::int32_t a = first + j * (side + 1) + i, around[5] = { a, a + 1, a + side + 2, a + side + 1, a };
      const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
      add(i + 0.5, j + 0.5);
      for (int n = 0; n < 4; ++n)
        mesh.triangles.push_back({ { around[upper ? n : n + 1], around[upper ? n + 1 : n], middle } });
    }
}

}  // namespace

Model touching_blocks(std::int32_t height, bool contact, double friction)
{
  VoxelBox box{ { { side, side, 2 * height + 1 } }, { { edge, edge, edge } }, { neo_hookean(34e3, 0.45) } };
  box.fill = [height](const Voxel& v) { return v[2] == height ? 0.0 : 1.0; };
  Model model = voxel_model(box);
  model.damping = 3000;
  const double top = (2 * height + 1) * edge;
  hold(model, [](const Point& p) { return p[2] == 0; });
  prescribe(model, nodes_where(model, [&](const Point& p) { return p[2] > top - 0.5 * edge; }),
            { { true, true, true } }, { { 0, 0, way } });
  if (!contact)
    return model;
  SelfContact surface;
  surface.name = "blocks";
  surface.friction = friction;
  add_side(model, surface, height - 1, true);
  add_side(model, surface, height + 1, false);
  model.self_contacts.push_back(surface);
  return model;
}

Vectors touching_start(const Model& model)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n][2] = 2 * model.nodes[n][2] > model.size[2] ? way : 0;
  return u;
}

}  // namespace frontalis
