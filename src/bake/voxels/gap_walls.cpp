#include "bake/voxels/gap_walls.hpp"

#include "bake/messages.hpp"

namespace frontalis
{
namespace
{

constexpr double widest_gap = 2.2;  // in voxel edges; wider gaps leave a layer of voxels empty

/// Calls call(point) for points of a triangle at distances of at most `spacing`.
template <class Call>
void each_point(const std::array<Vector3d, 3>& v, double spacing, const Call& call)
{
  const double longest =
      std::sqrt(std::max({ (v[1] - v[0]).squaredNorm(), (v[2] - v[1]).squaredNorm(), (v[0] - v[2]).squaredNorm() }));
  const int parts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts - i; ++j)
    {
      const double a = (i + 1.0 / 3) / parts, b = (j + 1.0 / 3) / parts;
      call(Vector3d(v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0])));
    }
}

}  // namespace

GapWalls::GapWalls(const Volumes& volumes, const PreparedSurfaces& surfaces, const Vector3d& spacing)
{
  const auto bit = [&](std::size_t body, double sign)
  {
    const PreparedSurface* surface = &volumes.body(body);
    const auto known = std::find(walls_.begin(), walls_.end(), surface);
    const auto index = static_cast<std::size_t>(known - walls_.begin());
    if (known == walls_.end())
    {
      walls_.push_back(surface);
      sign_.push_back(sign);
    }
    if (index > 63)
      throw Error("volumes: more than 64 surfaces bound the tissue; gaps can be parted between at most 64");
    return std::uint64_t{ 1 } << index;
  };
  for (const Volumes::Entry& entry : volumes.entries())
  {
    if (!entry.volume->tissue)
      continue;
    Tissue tissue;
    if (entry.closed_by)
      tissue.closed_by = bit(*entry.closed_by, 1);
    for (const std::size_t b : entry.inside)
      tissue.inside |= bit(b, 1);
    for (const std::size_t b : entry.outside)
      tissue.outside |= bit(b, -1);
    tissue_.push_back(tissue);
  }
  bodies_ = walls_.size();
  for (const PreparedSurface* const body : walls_)
    own_.push_back(static_cast<std::int32_t>(body->mesh().triangles.size()));
  for (const Volumes::Entry& entry : volumes.entries())
    for (const std::string& name : entry.volume->slits)
    {
      const PreparedSurface& slit = named_surface(surfaces, name, volumes.place(*entry.volume));
      slits_.push_back(std::make_unique<PreparedSurface>(name, continued(slit.mesh(), spacing)));
      walls_.push_back(slits_.back().get());
      own_.push_back(static_cast<std::int32_t>(slit.mesh().triangles.size()));
    }
}

bool GapWalls::is_tissue(std::uint64_t enclosing) const
{
  return std::any_of(tissue_.begin(), tissue_.end(),
                     [&](const Tissue& tissue)
                     {
                       return (enclosing & tissue.closed_by) == tissue.closed_by &&
                              (tissue.inside == 0 || (enclosing & tissue.inside) != 0) &&
                              (enclosing & tissue.outside) == 0;
                     });
}

std::vector<GapWalls::Piece> GapWalls::pieces_in(const Box& box) const
{
  std::vector<Piece> pieces;
  std::vector<std::int32_t> triangles;
  for (std::size_t w = 0; w < walls_.size(); ++w)
  {
    triangles.clear();
    walls_[w]->tree().gather(box, triangles);
    for (const std::int32_t t : triangles)
      pieces.push_back({ static_cast<std::int32_t>(w), t, t >= own_[w] });
  }
  return pieces;
}

std::uint64_t GapWalls::enclosing(const Vector3d& p) const
{
  std::uint64_t bits = 0;
  for (std::size_t b = 0; b < bodies_; ++b)
    if ((!walls_[b]->closed() || walls_[b]->box().contains(p)) && walls_[b]->tree().winding_number(p) > 0.5)
      bits |= std::uint64_t{ 1 } << b;
  return bits;
}

std::uint64_t GapWalls::enclosing(const Vector3d& p, const Vector3d& centre, std::uint64_t at_centre,
                                  const std::vector<Piece>& pieces) const
{
  for (std::size_t n = 0; n < pieces.size();)
  {
    const auto wall = static_cast<std::size_t>(pieces[n].wall);
    int change = 0;
    for (; n < pieces.size() && static_cast<std::size_t>(pieces[n].wall) == wall; ++n)
      change += crossing(walls_[wall]->mesh(), pieces[n].triangle, centre, p);
    if (wall >= bodies_ || change == 0)
      continue;
    const std::uint64_t bit = std::uint64_t{ 1 } << wall;
    at_centre = change > 0 ? at_centre | bit : at_centre & ~bit;
  }
  return at_centre;
}

GapWalls::Way GapWalls::way_out(const Vector3d& p, std::uint64_t enclosing, const Vector3d& q,
                                const std::vector<Piece>& pieces) const
{
  struct Event
  {
    double at;
    std::uint64_t bit;
    bool enters;
  };
  Event events[32];
  int count = 0;
  bool beyond = false;
  for (const Piece& piece : pieces)
  {
    const TriangleMesh& mesh = walls_[piece.wall]->mesh();
    const int way = crossing(mesh, piece.triangle, p, q);
    if (way == 0)
      continue;
    beyond = beyond || piece.beyond;
    if (piece.beyond)
      continue;
    if (static_cast<std::size_t>(piece.wall) >= bodies_ || count == 32)
      return Way::and_in;
    const auto v = corners(mesh, mesh.triangles[piece.triangle]);
    const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
    const double a = normal.dot(p - v[0]), b = normal.dot(q - v[0]);
    events[count++] = { a / (a - b), std::uint64_t{ 1 } << piece.wall, way > 0 };
  }
  std::sort(events, events + count, [](const Event& a, const Event& b) { return a.at < b.at; });
  bool left = false;
  for (int e = 0; e < count; ++e)
  {
    enclosing = events[e].enters ? enclosing | events[e].bit : enclosing & ~events[e].bit;
    const bool tissue = is_tissue(enclosing);
    if (left && tissue)
      return Way::and_in;
    left = left || !tissue;
  }
  return beyond ? Way::beyond : left ? Way::out : Way::inside;
}

double GapWalls::gap_at(const Volumes& volumes, const Vector3d& p, const Vector3d& away, double widest) const
{
  const double nudge = 1e-4 * widest;
  const Vector3d from = p + nudge * away, to = p + widest * away;
  std::vector<double> at;
  for (const Piece& piece : pieces_in(Box(from).extend(to)))
  {
    const TriangleMesh& mesh = walls_[piece.wall]->mesh();
    if (static_cast<std::size_t>(piece.wall) >= bodies_ || crossing(mesh, piece.triangle, from, to) == 0)
      continue;
    const auto v = corners(mesh, mesh.triangles[piece.triangle]);
    const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
    at.push_back(nudge + normal.dot(v[0] - from) / normal.dot(away));
  }
  if (at.empty() || !in_tissue(volumes, p - nudge * away) || in_tissue(volumes, from))
    return 0;
  std::sort(at.begin(), at.end());
  at.push_back(widest);
  for (std::size_t n = 0; n + 1 < at.size(); ++n)
    if (in_tissue(volumes, p + std::min(0.5 * (at[n] + at[n + 1]), at[n] + nudge) * away))
      return at[n];
  return 0;
}

std::vector<char> GapWalls::cells_with_gaps(const Volumes& volumes, const Grid& grid, bool thin_gaps,
                                            BakeMonitor& monitor) const
{
  const double edge = grid.spacing.maxCoeff(), step = 0.5 * grid.spacing.minCoeff();
  std::vector<char> cells(std::size_t{ 1 } * grid.size[0] * grid.size[1] * grid.size[2], 0);
  const Box all(grid.lower, grid.corner(grid.size));
  const auto mark = [&](const Vector3d& p)
  {
    if (!all.contains(p))
      return;
    const Vector3d cell = (p - grid.lower).cwiseQuotient(grid.spacing);
    std::size_t index = 0;
    for (int a = 2; a >= 0; --a)
      index = index * grid.size[a] + std::min(static_cast<std::int32_t>(cell[a]), grid.size[a] - 1);
    cells[index] = 1;
  };
  for (std::size_t w = thin_gaps ? 0 : bodies_; w < walls_.size(); ++w)
  {
    const TriangleMesh& mesh = walls_[w]->mesh();
    // Marks are collected per triangle and joined afterwards, because threads must not share cells.
    std::vector<std::vector<Vector3d>> marks(mesh.triangles.size());
    parallel_for(monitor, mesh.triangles.size(), 256,
                 [&](std::size_t t)
                 {
                   const auto v = corners(mesh, mesh.triangles[t]);
                   if (!all.intersects(Box(v[0]).extend(v[1]).extend(v[2])))
                     return;
                   // `slits` have no side
                   const Vector3d normal = (w < bodies_ ? sign_[w] : 1) * (v[1] - v[0]).cross(v[2] - v[0]).normalized();
                   each_point(v, step,
                              [&](const Vector3d& p)
                              {
                                if (!all.contains(p))
                                  return;
                                const double width = w < bodies_ ? gap_at(volumes, p, normal, widest_gap * edge) : 0;
                                if (w < bodies_ && !(width > 0))
                                  return;
                                for (double at = 0; at < width + step; at += step)
                                  marks[t].push_back(p + std::min(at, width) * normal);
                              });
                 });
    for (const auto& points : marks)
      std::for_each(points.begin(), points.end(), mark);
  }
  return cells;
}

}  // namespace frontalis
