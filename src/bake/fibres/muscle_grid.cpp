#include "bake/fibres/muscle_grid.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

/// Dense array over the box of the grid, one cell wider on each side than the mesh.
class CellBox
{
public:
  explicit CellBox(const std::array<std::int32_t, 3>& size)
      : size_(size),
        values_(
            static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]),
            -1)
  {
  }
  bool holds(const std::array<std::int32_t, 3>& c) const
  {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < size_[0] && c[1] < size_[1] && c[2] < size_[2];
  }
  std::int32_t& at(const std::array<std::int32_t, 3>& c) { return values_[index(c)]; }
  std::size_t index(const std::array<std::int32_t, 3>& c) const
  {
    return static_cast<std::size_t>(c[0]) +
           static_cast<std::size_t>(size_[0]) *
               (static_cast<std::size_t>(c[1]) + static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(c[2]));
  }
  const std::array<std::int32_t, 3>& size() const { return size_; }

private:
  std::array<std::int32_t, 3> size_;
  std::vector<std::int32_t> values_;
};

constexpr std::array<std::array<std::int32_t, 3>, 6> faces{
  { { -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, 0 }, { 0, 1, 0 }, { 0, 0, -1 }, { 0, 0, 1 } }
};

std::array<std::int32_t, 3> sum(const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

/// Samples so dense that no cell-to-cell way through the surface misses them.
void sample_surface(const TriangleMesh& mesh, MuscleGrid& grid)
{
  for (const Triangle& t : mesh.triangles)
  {
    const Vector3 &a = mesh.vertices[static_cast<std::size_t>(t[0])],
                  &b = mesh.vertices[static_cast<std::size_t>(t[1])],
                  &c = mesh.vertices[static_cast<std::size_t>(t[2])];
    const Vector3 product = cross(b - a, c - a);
    const double longest = std::max({ norm(b - a), norm(c - b), norm(a - c) });
    const int n = std::max(1, static_cast<int>(std::ceil(2 * longest / grid.edge)));
    MuscleGrid::Sample sample;
    sample.normal = normalised(product);
    sample.area = 0.5 * norm(product) / (n * n);
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; i + j < n; ++j)
      {
        for (int turned = 0; turned < (i + j + 1 < n ? 2 : 1); ++turned)
        {
          const double s = (i + (1 + turned) / 3.0) / n, r = (j + (1 + turned) / 3.0) / n;
          sample.point = a + s * (b - a) + r * (c - a);
          grid.samples.push_back(sample);
        }
      }
    }
  }
}

/// 0 where a cell is outside: reached from the box's border without passing a cell of the surface (1).
void flood_outside(CellBox& box)
{
  std::vector<std::array<std::int32_t, 3>> front{ { 0, 0, 0 } };
  box.at(front.front()) = 0;
  while (!front.empty())
  {
    const auto place = front.back();
    front.pop_back();
    for (const auto& step : faces)
    {
      const auto next = sum(place, step);
      if (box.holds(next) && box.at(next) == -1)
      {
        box.at(next) = 0;
        front.push_back(next);
      }
    }
  }
}

/// Cells (value not 0) of the largest part connected through faces, edges or corners. Values become -2.
std::vector<std::array<std::int32_t, 3>> largest_part(CellBox& box, double& kept)
{
  std::vector<std::array<std::int32_t, 3>> best;
  std::size_t all = 0;
  std::array<std::int32_t, 3> c{};
  for (c[2] = 0; c[2] < box.size()[2]; ++c[2])
    for (c[1] = 0; c[1] < box.size()[1]; ++c[1])
      for (c[0] = 0; c[0] < box.size()[0]; ++c[0])
      {
        if (box.at(c) == 0 || box.at(c) == -2)
          continue;
        std::vector<std::array<std::int32_t, 3>> part{ c };
        box.at(c) = -2;
        for (std::size_t front = 0; front < part.size(); ++front)
        {
          for (int s = 0; s < 27; ++s)
          {
            const auto next = sum(part[front], { s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1 });
            if (box.holds(next) && box.at(next) != 0 && box.at(next) != -2)
            {
              box.at(next) = -2;
              part.push_back(next);
            }
          }
        }
        all += part.size();
        if (part.size() > best.size())
          best = std::move(part);
      }
  kept = static_cast<double>(best.size()) / static_cast<double>(all);
  std::sort(best.begin(), best.end(),
            [](const auto& a, const auto& b)
            { return a[2] != b[2] ? a[2] < b[2] : (a[1] != b[1] ? a[1] < b[1] : a[0] < b[0]); });
  return best;
}

void number_nodes(MuscleGrid& grid, const std::array<std::int32_t, 3>& size)
{
  CellBox numbers({ size[0] + 1, size[1] + 1, size[2] + 1 });
  for (const auto& cell : grid.cells)
  {
    std::array<std::int32_t, 8> corners{};
    for (std::int32_t b = 0; b < 8; ++b)
    {
      const auto place = sum(cell, { b & 1, b >> 1 & 1, b >> 2 });
      std::int32_t& number = numbers.at(place);
      if (number < 0)
      {
        number = static_cast<std::int32_t>(grid.nodes.size());
        grid.nodes.push_back(place);
      }
      corners[static_cast<std::size_t>(b)] = number;
    }
    grid.cell_nodes.push_back(corners);
  }
}

}  // namespace

Vector3 MuscleGrid::cell_centre(std::size_t cell) const
{
  const auto& c = cells[cell];
  return lower + edge * Vector3{ c[0] + 0.5, c[1] + 0.5, c[2] + 0.5 };
}

Vector3 MuscleGrid::node_position(std::size_t node) const
{
  const auto& n = nodes[node];
  return lower + edge * Vector3{ 1.0 * n[0], 1.0 * n[1], 1.0 * n[2] };
}

std::array<double, 8> MuscleGrid::weights(std::size_t cell, const Vector3& p) const
{
  std::array<double, 8> result{};
  result.fill(1);
  for (std::size_t a = 0; a < 3; ++a)
  {
    const double t = (p[a] - lower[a]) / edge - cells[cell][a];
    for (std::size_t b = 0; b < 8; ++b)
      result[b] *= (b >> a & 1) != 0 ? t : 1 - t;
  }
  return result;
}

MuscleGrid make_muscle_grid(const TriangleMesh& mesh, double wanted, double coarser)
{
  MuscleGrid grid;
  double area = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const Vector3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * norm(cross(mesh.vertices[static_cast<std::size_t>(t[1])] - a,
                             mesh.vertices[static_cast<std::size_t>(t[2])] - a));
  }
  const Box bounds = bounding_box(mesh);
  const double diagonal = norm(bounds.upper - bounds.lower);
  // as many cells by volume, or by area where the muscle is thinner than they are
  const double size =
      std::max(std::cbrt(std::abs(signed_volume(mesh)) / wanted), std::sqrt(0.5 * area / (1.5 * wanted)));
  grid.edge = coarser * std::min(diagonal / 10, std::max(diagonal / 300, size));

  std::array<std::int32_t, 3> box_size{};
  for (std::size_t a = 0; a < 3; ++a)
  {
    // surfaces along the axes pass through the middle of cells
    grid.lower[a] = bounds.lower[a] - 1.5 * grid.edge;
    box_size[a] = static_cast<std::int32_t>(std::ceil((bounds.upper[a] - grid.lower[a]) / grid.edge)) + 2;
  }
  sample_surface(mesh, grid);
  const auto place = [&grid](const Vector3& p)
  {
    std::array<std::int32_t, 3> cell{};
    for (std::size_t a = 0; a < 3; ++a)
      cell[a] = static_cast<std::int32_t>((p[a] - grid.lower[a]) / grid.edge);
    return cell;
  };
  CellBox box(box_size);
  for (const MuscleGrid::Sample& sample : grid.samples)
    box.at(place(sample.point)) = 1;
  flood_outside(box);
  grid.cells = largest_part(box, grid.kept);
  CellBox numbers(box_size);
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    numbers.at(grid.cells[c]) = static_cast<std::int32_t>(c);
  for (MuscleGrid::Sample& sample : grid.samples)
    sample.cell = numbers.at(place(sample.point));
  number_nodes(grid, box_size);
  return grid;
}

void spread(const MuscleGrid& grid, double reach, std::vector<SymmetricTensor>& tensors)
{
  std::array<std::int32_t, 3> size{};
  for (const auto& cell : grid.cells)
    for (std::size_t a = 0; a < 3; ++a)
      size[a] = std::max(size[a], cell[a] + 1);
  CellBox numbers(size);
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    numbers.at(grid.cells[c]) = static_cast<std::int32_t>(c);
  std::vector<std::array<std::int32_t, 6>> neighbours(grid.cells.size());
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    for (std::size_t f = 0; f < 6; ++f)
    {
      const auto next = sum(grid.cells[c], faces[f]);
      neighbours[c][f] = numbers.holds(next) ? numbers.at(next) : -1;
    }
  // averaging over neighbours adds a variance of 2/7 edge^2 an axis each turn
  const double turns = 3.5 * (reach / grid.edge) * (reach / grid.edge);
  std::vector<SymmetricTensor> next(tensors.size());
  for (int turn = 0; turn < std::min(200.0, turns); ++turn)
  {
    for (std::size_t c = 0; c < tensors.size(); ++c)
    {
      next[c] = tensors[c];
      for (const std::int32_t n : neighbours[c])
        for (std::size_t k = 0; n >= 0 && k < 6; ++k)
          next[c][k] += tensors[static_cast<std::size_t>(n)][k];
      for (double& value : next[c])
        value /= 7;
    }
    std::swap(tensors, next);
  }
}

}  // namespace frontalis
