#include "bake/fibres/muscle_grid.hpp"

#include <tuple>

namespace frontalis
{
namespace
{

using Eigen::Vector3i;

/// One number per cell of a box of cells, initially -1.
class CellBox
{
public:
  explicit CellBox(const Vector3i& size) : size_(size), values_(std::size_t{ 1 } * size[0] * size[1] * size[2], -1) {}
  bool holds(const Vector3i& c) const { return c.minCoeff() >= 0 && (size_ - c).minCoeff() > 0; }
  std::int32_t& at(const Vector3i& c)
  {
    return values_[c[0] + std::size_t{ 1 } * size_[0] * (c[1] + std::size_t{ 1 } * size_[1] * c[2])];
  }
  const Vector3i& size() const { return size_; }

private:
  Vector3i size_;
  std::vector<std::int32_t> values_;
};

/// Box with the index of each cell of the grid; -1 in all other cells.
CellBox cell_numbers(const MuscleGrid& grid, const Vector3i& size)
{
  CellBox numbers(size);
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    numbers.at(grid.cells[c]) = static_cast<std::int32_t>(c);
  return numbers;
}

/// Offsets to the neighbours of a cell across its faces.
std::vector<Vector3i> face_steps()
{
  std::vector<Vector3i> steps;
  steps.reserve(6);
  for (int face = 0; face < 6; ++face)
    steps.emplace_back((face % 2 == 0 ? -1 : 1) * Vector3i::Unit(face / 2));
  return steps;
}

/// Samples the surface so densely that the cells with a sample form a closed hull.
void sample_surface(const TriangleMesh& mesh, MuscleGrid& grid)
{
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    const Vector3d product = (b - a).cross(c - a);
    const double longest = std::max({ (b - a).norm(), (c - b).norm(), (a - c).norm() });
    const int n = std::max(1, static_cast<int>(std::ceil(2 * longest / grid.edge)));
    MuscleGrid::Sample sample;
    sample.normal = product.normalized();
    sample.area = 0.5 * product.norm() / (n * n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        for (int turned = 0; turned < (i + j + 1 < n ? 2 : 1); ++turned)
        {
          const double s = (i + (1 + turned) / 3.0) / n, r = (j + (1 + turned) / 3.0) / n;
          sample.point = a + s * (b - a) + r * (c - a);
          grid.samples.push_back(sample);
        }
  }
}

// Values in a CellBox while the cells are classified; enclosed cells keep -1.
constexpr std::int32_t outside = 0, on_surface = 1, visited = -2;

/// Marks the cells that are connected to the box's border without passing a cell of the surface.
void flood_outside(CellBox& box)
{
  const auto take = [&box](const Vector3i& place)
  {
    const bool taken = box.holds(place) && box.at(place) == -1;
    if (taken)
      box.at(place) = outside;
    return taken;
  };
  flood<Vector3i>(Vector3i::Zero(), face_steps(), take);
}

/// Largest connected component of the cells that are not outside, where cells with a common face, edge or corner are
/// connected. `kept` receives the fraction of the cells that are in the component.
std::vector<Vector3i> largest_part(CellBox& box, double& kept)
{
  std::vector<Vector3i> steps;
  steps.reserve(27);
  for (int s = 0; s < 27; ++s)
    steps.emplace_back(s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1);
  const auto take = [&box](const Vector3i& place)
  {
    const bool taken = box.holds(place) && box.at(place) != outside && box.at(place) != visited;
    if (taken)
      box.at(place) = visited;
    return taken;
  };
  std::vector<Vector3i> best;
  std::size_t all = 0;
  for (int k = 0; k < box.size()[2]; ++k)
    for (int j = 0; j < box.size()[1]; ++j)
      for (int i = 0; i < box.size()[0]; ++i)
      {
        if (!take({ i, j, k }))
          continue;
        std::vector<Vector3i> part = flood(Vector3i(i, j, k), steps, take);
        all += part.size();
        if (part.size() > best.size())
          best = std::move(part);
      }
  kept = static_cast<double>(best.size()) / static_cast<double>(all);
  std::sort(best.begin(), best.end(),
            [](const Vector3i& a, const Vector3i& b)
            { return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]); });
  return best;
}

void number_nodes(MuscleGrid& grid, const Vector3i& size)
{
  CellBox numbers(size + Vector3i::Ones());
  for (const Vector3i& cell : grid.cells)
  {
    std::array<std::int32_t, 8> nodes{};
    for (int b = 0; b < 8; ++b)
    {
      const Vector3i place = cell + Vector3i(b & 1, b >> 1 & 1, b >> 2);
      std::int32_t& number = numbers.at(place);
      if (number < 0)
      {
        number = static_cast<std::int32_t>(grid.nodes.size());
        grid.nodes.push_back(place);
      }
      nodes[b] = number;
    }
    grid.cell_nodes.push_back(nodes);
  }
}

}  // namespace

Box MuscleGrid::box() const
{
  Box box;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    box.extend(node_position(n));
  return box;
}

std::array<double, 8> MuscleGrid::weights(std::size_t cell, const Vector3d& p) const
{
  std::array<double, 8> result{};
  result.fill(1);
  for (int a = 0; a < 3; ++a)
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
  const Box bounds = bounding_box(mesh);
  const double diagonal = bounds.diagonal().norm();
  // The edge of cells follows from the volume or, if the muscle is thinner than a cell, from the area.
  const double wanted_edge =
      std::max(std::cbrt(std::abs(signed_volume(mesh)) / wanted), std::sqrt(0.5 * surface_area(mesh) / (1.5 * wanted)));
  grid.edge = coarser * std::min(diagonal / 10, std::max(diagonal / 300, wanted_edge));

  // The margin of 1.5 cells puts surfaces that are normal to an axis into the middle of cells.
  grid.lower = bounds.min() - Vector3d::Constant(1.5 * grid.edge);
  const Vector3i size =
      ((bounds.max() - grid.lower) / grid.edge).array().ceil().cast<int>().matrix() + Vector3i::Constant(2);
  sample_surface(mesh, grid);
  const auto place = [&grid](const Vector3d& p) -> Vector3i { return ((p - grid.lower) / grid.edge).cast<int>(); };
  CellBox box(size);
  for (const MuscleGrid::Sample& sample : grid.samples)
    box.at(place(sample.point)) = on_surface;
  flood_outside(box);
  grid.cells = largest_part(box, grid.kept);
  CellBox numbers = cell_numbers(grid, size);
  for (MuscleGrid::Sample& sample : grid.samples)
    sample.cell = numbers.at(place(sample.point));
  number_nodes(grid, size);
  return grid;
}

void smooth(const MuscleGrid& grid, double reach, std::vector<Eigen::Matrix3d>& tensors)
{
  Vector3i size = Vector3i::Zero();
  for (const Vector3i& cell : grid.cells)
    size = size.cwiseMax(cell + Vector3i::Ones());
  CellBox numbers = cell_numbers(grid, size);
  const std::vector<Vector3i> steps = face_steps();
  std::vector<std::vector<std::int32_t>> neighbours(grid.cells.size());
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    for (const Vector3i& step : steps)
      if (const Vector3i next = grid.cells[c] + step; numbers.holds(next) && numbers.at(next) >= 0)
        neighbours[c].push_back(numbers.at(next));
  // Each average over a cell and its six neighbours adds a variance of 2/7 edge^2 along each axis.
  const double averages = std::min(200.0, 3.5 * (reach / grid.edge) * (reach / grid.edge));
  std::vector<Eigen::Matrix3d> next(tensors.size());
  for (int average = 0; average < averages; ++average)
  {
    for (std::size_t c = 0; c < tensors.size(); ++c)
    {
      next[c] = tensors[c];
      for (const std::int32_t n : neighbours[c])
        next[c] += tensors[n];
      next[c] /= 7;
    }
    std::swap(tensors, next);
  }
}

}  // namespace frontalis
