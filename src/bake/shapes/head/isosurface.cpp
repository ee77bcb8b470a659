#include "bake/shapes/head/head.hpp"

namespace frontalis
{
namespace
{

/// The six tetrahedra about the diagonal of a cube; corner bits are x, y, z.
constexpr int tetrahedra[6][4] = { { 0, 1, 3, 7 }, { 0, 3, 2, 7 }, { 0, 2, 6, 7 },
                                   { 0, 6, 4, 7 }, { 0, 4, 5, 7 }, { 0, 5, 1, 7 } };

class Marching
{
public:
  Marching(const std::function<double(const Vector3d&)>& f, const Box& half, double edge)
      : origin_(half.min()), edge_(edge)
  {
    for (int a = 0; a < 3; ++a)
      size_[a] = std::max(2, static_cast<int>(std::ceil(half.sizes()[a] / edge)) + 1);
    values_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    for (int k = 0; k < size_[2]; ++k)
      for (int j = 0; j < size_[1]; ++j)
        for (int i = 0; i < size_[0]; ++i)
        {
          const bool border = i == 0 || i == size_[0] - 1 || j == size_[1] - 1 || k == 0 || k == size_[2] - 1;
          const double value = f(at({ i, j, k }));
          // the surface is closed at the border, and no corner lies on it
          values_[number({ i, j, k })] = border ? std::max(value, edge) : std::abs(value) < 1e-9 ? 1e-9 : value;
        }
  }

  TriangleMesh surface() const
  {
    TriangleMesh mesh;
    for (int k = 0; k + 1 < size_[2]; ++k)
      for (int j = 0; j + 1 < size_[1]; ++j)
        for (int i = 0; i + 1 < size_[0]; ++i)
          for (const auto& t : tetrahedra)
            add(mesh, { i, j, k }, t);
    return mesh;
  }

private:
  using Index = std::array<int, 3>;

  std::size_t number(const Index& i) const
  {
    return (static_cast<std::size_t>(i[2]) * size_[1] + i[1]) * size_[0] + i[0];
  }
  Vector3d at(const Index& i) const
  {
    return { origin_[0] + edge_ * i[0], i[1] == 0 ? origin_[1] : origin_[1] + edge_ * i[1], origin_[2] + edge_ * i[2] };
  }

  void add(TriangleMesh& mesh, const Index& cell, const int (&corner)[4]) const
  {
    std::array<Index, 4> index{};
    std::array<double, 4> value{};
    std::vector<int> in, out;
    for (int c = 0; c < 4; ++c)
    {
      index[c] = { cell[0] + (corner[c] & 1), cell[1] + (corner[c] >> 1 & 1), cell[2] + (corner[c] >> 2 & 1) };
      value[c] = values_[number(index[c])];
      (value[c] < 0 ? in : out).push_back(c);
    }
    if (in.empty() || out.empty())
      return;
    const auto cut = [&](int a, int b) -> Vector3d
    {
      // from the lower corner on, so that neighbours find the same point
      if (number(index[a]) > number(index[b]))
        std::swap(a, b);
      const double share = value[a] / (value[a] - value[b]);
      return at(index[a]) + std::min(0.98, std::max(0.02, share)) * (at(index[b]) - at(index[a]));
    };
    const Vector3d outward = at(index[out[0]]) - at(index[in[0]]);
    const auto triangle = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c)
    {
      const bool turned = (b - a).cross(c - a).dot(outward) < 0;
      const auto base = static_cast<std::int32_t>(mesh.vertices.size());
      for (const Vector3d& p : { a, turned ? c : b, turned ? b : c })
        mesh.vertices.push_back(to_array(p));
      mesh.triangles.push_back({ base, base + 1, base + 2 });
    };
    if (in.size() == 1)
      triangle(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2]));
    else if (in.size() == 3)
      triangle(cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0]));
    else
    {
      const Vector3d a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]), d = cut(in[1], out[0]);
      triangle(a, b, c);
      triangle(a, c, d);
    }
  }

  Vector3d origin_;
  double edge_;
  Index size_{};
  std::vector<double> values_;
};

}  // namespace

TriangleMesh isosurface(const std::function<double(const Vector3d&)>& f, const Box& half, double edge)
{
  TriangleMesh mesh = Marching(f, half, edge).surface();
  TriangleMesh image = mesh;
  for (Vector3& p : image.vertices)
    p[1] = p[1] == 0 ? 0 : -p[1];
  append(mesh, image, true);
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
