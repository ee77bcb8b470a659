#pragma once

#include "block_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace frontalis
{
namespace test
{

/// Adds a piece of surface over part of a grid. `place` gives the position [m] of a point (x, y), `voxel` the voxel
/// that moves it. Each square has a vertex in the middle, so that a uniform pressure gives each of the four nodes a
/// quarter of its force. The normal is along x cross y, or opposite to it if the surface is `turned`.
inline void add_surface(const Model& model, SelfContact& contact, std::int32_t nx, std::int32_t ny, bool turned,
                        const std::function<std::array<double, 3>(double, double)>& place,
                        const std::function<std::array<std::int32_t, 3>(double, double)>& voxel)
{
  TriangleMesh& mesh = contact.surface;
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  const auto add = [&](double x, double y)
  {
    const auto p = place(x, y);
    const auto at = voxel(x, y);
    mesh.vertices.push_back(p);
    const auto found = std::find(model.voxels.begin(), model.voxels.end(), at);
    contact.binding.voxel.push_back(static_cast<std::int32_t>(found - model.voxels.begin()));
    std::array<float, 3> coordinates{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinates[axis] = static_cast<float>(p[axis] / model.spacing[axis] - at[axis]);
    contact.binding.coordinates.push_back(coordinates);
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      add(i, j);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
    {
      const std::int32_t a = first + j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
      add(i + 0.5, j + 0.5);
      for (const auto& edge :
           { std::make_pair(a, b), std::make_pair(b, d), std::make_pair(d, c), std::make_pair(c, a) })
        if (turned)
          mesh.triangles.push_back({ { edge.second, edge.first, middle } });
        else
          mesh.triangles.push_back({ { edge.first, edge.second, middle } });
    }
}

/// Adds the upper or lower side of the voxels in layer k from column `begin` to `end`, moved outwards by `beyond` voxel
/// edges.
inline void add_side(const Model& model, SelfContact& contact, std::int32_t k, bool upper, double beyond = 0,
                     std::int32_t begin = 0, std::int32_t end = -1)
{
  const auto& h = model.spacing;
  const std::int32_t last = end < 0 ? model.size[0] : end, ny = model.size[1];
  const double z = upper ? k + 1 + beyond : k - beyond;
  add_surface(
      model, contact, last - begin, ny, !upper,
      [&](double x, double y) {
        return std::array<double, 3>{ { (begin + x) * h[0], y * h[1], z * h[2] } };
      },
      [&](double x, double y)
      {
        return std::array<std::int32_t, 3>{ { std::min(begin + static_cast<std::int32_t>(x), last - 1),
                                              std::min(static_cast<std::int32_t>(y), ny - 1), k } };
      });
}

/// Two blocks of `settings.voxels` voxels each, one voxel edge apart along z, whose facing sides may touch. `beyond`:
/// distance of the surfaces outside the voxels, in voxel edges.
inline Model two_blocks(BlockSettings settings, double friction = 0, double beyond = 0)
{
  const std::int32_t height = settings.voxels[2];
  settings.voxels[2] = 2 * height + 1;
  settings.keep = [height](std::int32_t, std::int32_t, std::int32_t k) { return k != height; };
  Model model = block_model(settings);
  SelfContact contact;
  contact.name = "blocks";
  contact.friction = friction;
  add_side(model, contact, height - 1, true, beyond);
  add_side(model, contact, height + 1, false, beyond);
  model.self_contacts.push_back(contact);
  return model;
}

/// Adds a sphere whose vertices are bound to the nearest voxels. The sphere is an octahedron whose triangles are
/// divided into four, four times in succession.
inline void add_sphere(const Model& model, SelfContact& contact, const std::array<double, 3>& centre, double radius)
{
  using Point = std::array<double, 3>;
  const auto middle = [](const Point& a, const Point& b)
  {
    const Point sum{ { a[0] + b[0], a[1] + b[1], a[2] + b[2] } };
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    return Point{ { sum[0] / length, sum[1] / length, sum[2] / length } };
  };
  std::vector<std::array<Point, 3>> triangles;
  for (int octant = 0; octant < 8; ++octant)
  {
    const double x = octant & 1 ? 1 : -1, y = octant & 2 ? 1 : -1, z = octant & 4 ? 1 : -1;
    const Point a{ { x, 0, 0 } }, b{ { 0, y, 0 } }, c{ { 0, 0, z } };
    triangles.push_back(x * y * z > 0 ? std::array<Point, 3>{ { a, b, c } } : std::array<Point, 3>{ { a, c, b } });
  }
  for (int division = 0; division < 4; ++division)
  {
    std::vector<std::array<Point, 3>> finer;
    for (const auto& [a, b, c] : triangles)
    {
      const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), { { { a, ab, ca } }, { { ab, b, bc } }, { { ca, bc, c } }, { { ab, bc, ca } } });
    }
    triangles = std::move(finer);
  }
  std::map<Point, std::int32_t> known;
  for (const auto& corners : triangles)
  {
    auto& triangle = contact.surface.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto [found, fresh] = known.emplace(corners[i], static_cast<std::int32_t>(contact.surface.vertices.size()));
      triangle[i] = found->second;
      if (!fresh)
        continue;
      Point p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = centre[axis] + radius * corners[i][axis];
      const auto way = [&](const std::array<std::int32_t, 3>& voxel)
      {
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          squared += std::pow(p[axis] / model.spacing[axis] - voxel[axis] - 0.5, 2);
        return squared;
      };
      const auto nearest = std::min_element(model.voxels.begin(), model.voxels.end(),
                                            [&](const auto& a, const auto& b) { return way(a) < way(b); });
      contact.surface.vertices.push_back(p);
      contact.binding.voxel.push_back(static_cast<std::int32_t>(nearest - model.voxels.begin()));
      auto& coordinates = contact.binding.coordinates.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        coordinates[axis] = static_cast<float>(p[axis] / model.spacing[axis] - (*nearest)[axis]);
    }
  }
}

/// Joins adjacent pieces to one surface: vertices at the same place become one.
inline void join(SelfContact& contact)
{
  std::map<std::array<double, 3>, std::int32_t> first;
  SelfContact joined{ contact.name, contact.friction, {}, {} };
  for (const auto& triangle : contact.surface.triangles)
  {
    auto& corners = joined.surface.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto v = triangle[i];
      const auto [found, fresh] =
          first.emplace(contact.surface.vertices[v], static_cast<std::int32_t>(joined.surface.vertices.size()));
      corners[i] = found->second;
      if (!fresh)
        continue;
      joined.surface.vertices.push_back(contact.surface.vertices[v]);
      joined.binding.voxel.push_back(contact.binding.voxel[v]);
      joined.binding.coordinates.push_back(contact.binding.coordinates[v]);
    }
  }
  contact = joined;
}

/// A sheet along x, one voxel thick, folded over a slit of one voxel: two arms, joined at the upper end of x. The
/// surface that may touch itself has all sides along z, and the end of the slit.
inline Model folded_sheet(BlockSettings settings, std::int32_t slit, double friction = 0)
{
  settings.voxels[2] = 3;
  settings.keep = [slit](std::int32_t i, std::int32_t, std::int32_t k) { return k != 1 || i >= slit; };
  Model model = block_model(settings);
  SelfContact contact;
  contact.name = "fold";
  contact.friction = friction;
  add_side(model, contact, 0, false);
  add_side(model, contact, 0, true, 0, 0, slit);
  add_side(model, contact, 2, false, 0, 0, slit);
  add_side(model, contact, 2, true);
  const auto& h = model.spacing;
  add_surface(
      model, contact, settings.voxels[1], 1, true,
      [&](double y, double z) {
        return std::array<double, 3>{ { slit * h[0], y * h[1], (1 + z) * h[2] } };
      },
      [&](double y, double) {
        return std::array<std::int32_t, 3>{ { slit, std::min(static_cast<std::int32_t>(y), settings.voxels[1] - 1),
                                              1 } };
      });
  join(contact);
  model.self_contacts.push_back(contact);
  return model;
}

}  // namespace test
}  // namespace frontalis
