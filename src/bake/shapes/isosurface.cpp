#include "bake/shapes/isosurface.hpp"

#include "bake/mesh/surface.hpp"

#include <map>

namespace frontalis
{
namespace
{

/// The six tetrahedra around the diagonal of a cube. Bits 0, 1, 2 of a corner's number are its x, y, z.
constexpr int tetrahedra[6][4] = { { 0, 1, 3, 7 }, { 0, 3, 2, 7 }, { 0, 2, 6, 7 },
                                   { 0, 6, 4, 7 }, { 0, 4, 5, 7 }, { 0, 5, 1, 7 } };

/// Marching tetrahedra. Grid points that are close to the surface are moved onto it first, so that no triangle is thin
/// (Labelle & Shewchuk, Isosurface stuffing, SIGGRAPH 2007).
class Marching
{
public:
  /// `half`: the side of the box at the lowest y is a plane of symmetry, through which the surface goes on.
  Marching(const std::function<double(const Vector3d&)>& f, const Box& box, double edge, bool half, double error)
      : origin_(box.min()), edge_(edge), error_(error), half_(half)
  {
    for (int a = 0; a < 3; ++a)
      size_[a] = std::max(2, static_cast<int>(std::ceil(box.sizes()[a] / edge)) + 1);
    values_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    for (int k = 0; k < size_[2]; k += block)
      for (int j = 0; j < size_[1]; j += block)
        for (int i = 0; i < size_[0]; i += block)
          sample(f, { i, j, k });
    for (int k = 0; k < size_[2]; ++k)
      for (int j = 0; j < size_[1]; ++j)
        for (int i = 0; i < size_[0]; ++i)
          if (const Index point{ i, j, k }; near(point))
            if (const Vector3d place = snapped_place(point); place != at(point))
              snapped_[number(point)] = place;
    for (const auto& [point, place] : snapped_)
      values_[point] = 0;
  }

  TriangleMesh surface() const
  {
    TriangleMesh mesh;
    for (int k = 0; k + 1 < size_[2]; ++k)
      for (int j = 0; j + 1 < size_[1]; ++j)
        for (int i = 0; i + 1 < size_[0]; ++i)
          if (near({ i, j, k }))
            for (const auto& t : tetrahedra)
              add(mesh, { i, j, k }, t);
    return mesh;
  }

private:
  using Index = std::array<int, 3>;
  static constexpr int block = 4;

  std::size_t number(const Index& i) const
  {
    return (static_cast<std::size_t>(i[2]) * size_[1] + i[1]) * size_[0] + i[0];
  }
  Vector3d at(const Index& i) const
  {
    return { origin_[0] + edge_ * i[0], i[1] == 0 ? origin_[1] : origin_[1] + edge_ * i[1], origin_[2] + edge_ * i[2] };
  }

  /// If |f| is at least this value [m], the surface is farther away than the points of a block and their neighbours.
  double far() const { return 1.5 * block * edge_ + error_; }
  bool near(const Index& i) const { return std::abs(values_[number(i)]) < far(); }

  /// Fills the values at a block of grid points. If the block's middle is far from the surface, all points get its
  /// value.
  void sample(const std::function<double(const Vector3d&)>& f, const Index& first)
  {
    const double middle = f(at(first) + Vector3d::Constant(0.5 * (block - 1) * edge_));
    const bool near = std::abs(middle) < far();
    for (int k = first[2]; k < std::min(size_[2], first[2] + block); ++k)
      for (int j = first[1]; j < std::min(size_[1], first[1] + block); ++j)
        for (int i = first[0]; i < std::min(size_[0], first[0] + block); ++i)
        {
          const bool border =
              i == 0 || i == size_[0] - 1 || (j == 0 && !half_) || j == size_[1] - 1 || k == 0 || k == size_[2] - 1;
          const double value = near ? f(at({ i, j, k })) : middle;
          // Positive values close the surface at the border. Small values are raised, so that no grid point lies on the
          // surface.
          values_[number({ i, j, k })] = border ? std::max(value, edge_) : std::abs(value) < 1e-9 ? 1e-9 : value;
        }
  }

  Vector3d snapped_place(const Index& i) const
  {
    const Vector3d rest = at(i);
    const double value = values_[number(i)];
    Vector3d place = rest;
    double least = 0.3 * edge_;
    for (int n = 1; n < 8; ++n)
      for (const int side : { -1, 1 })
      {
        const Index other{ i[0] + side * (n & 1), i[1] + side * (n >> 1 & 1), i[2] + side * (n >> 2 & 1) };
        bool there = i[1] > 0 || other[1] == 0;  // points of the plane of symmetry stay in it
        for (std::size_t a = 0; a < 3; ++a)
          there = there && other[a] >= 0 && other[a] < size_[a];
        if (!there || (value < 0) == (values_[number(other)] < 0))
          continue;
        const Vector3d away = value / (value - values_[number(other)]) * (at(other) - rest);
        if (away.norm() >= least)
          continue;
        least = away.norm();
        place = rest + away;
      }
    return place;
  }

  void add(TriangleMesh& mesh, const Index& cell, const int (&corner)[4]) const
  {
    std::array<Index, 4> index{};
    std::vector<int> in, out;
    for (int c = 0; c < 4; ++c)
    {
      index[c] = { cell[0] + (corner[c] & 1), cell[1] + (corner[c] >> 1 & 1), cell[2] + (corner[c] >> 2 & 1) };
      (values_[number(index[c])] < 0 ? in : out).push_back(c);
    }
    if (in.empty() || out.empty())
      return;
    using Cut = std::pair<int, int>;  // a corner inside and a corner outside
    const auto place = [&](const Cut& cut) -> Vector3d
    {
      const std::size_t inner = number(index[cut.first]), outer = number(index[cut.second]);
      if (values_[outer] == 0)
        return snapped_.at(outer);
      // The position is interpolated from the point with the lower index, so that neighbours find the same position.
      const bool ordered = inner < outer;
      const std::size_t a = ordered ? inner : outer, b = ordered ? outer : inner;
      const Vector3d from = at(index[ordered ? cut.first : cut.second]),
                     to = at(index[ordered ? cut.second : cut.first]);
      return from + values_[a] / (values_[a] - values_[b]) * (to - from);
    };
    const Vector3d outward = at(index[out[0]]) - at(index[in[0]]);
    const auto triangle = [&](const Cut& a, const Cut& b, const Cut& c)
    {
      // The orientation is decided by grid points, because snapped corners may be collinear.
      const auto middle = [&](const Cut& cut) -> Vector3d { return at(index[cut.first]) + at(index[cut.second]); };
      const bool turned = (middle(b) - middle(a)).cross(middle(c) - middle(a)).dot(outward) < 0;
      const auto base = static_cast<std::int32_t>(mesh.vertices.size());
      for (const Vector3d& p : { place(a), place(turned ? c : b), place(turned ? b : c) })
        mesh.vertices.push_back(to_array(p));
      mesh.triangles.push_back({ base, base + 1, base + 2 });
    };
    if (in.size() == 1)
      triangle({ in[0], out[0] }, { in[0], out[1] }, { in[0], out[2] });
    else if (in.size() == 3)
      triangle({ in[0], out[0] }, { in[1], out[0] }, { in[2], out[0] });
    else
    {
      const Cut a{ in[0], out[0] }, c{ in[1], out[1] };
      triangle(a, { in[0], out[1] }, c);
      triangle(a, c, { in[1], out[0] });
    }
  }

  Vector3d origin_;
  double edge_, error_;
  bool half_;
  Index size_{};
  std::vector<double> values_;
  std::map<std::size_t, Vector3d> snapped_;  ///< positions of grid points that were moved onto the surface
};

}  // namespace

TriangleMesh isosurface(const std::function<double(const Vector3d&)>& f, const Box& box, double edge, bool mirrored,
                        double error)
{
  check_edges(edge, box.sizes().maxCoeff());
  TriangleMesh mesh = Marching(f, box, edge, mirrored, error).surface();
  if (mirrored)
  {
    TriangleMesh image = mesh;
    for (Vector3& p : image.vertices)
      p[1] = p[1] == 0 ? 0 : -p[1];
    append(mesh, image, true);
  }
  join_vertices(mesh);
  // Drops vertices that no triangle uses.
  return keep_triangles(mesh, std::vector<bool>(mesh.triangles.size(), true));
}

}  // namespace frontalis
