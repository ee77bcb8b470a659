#include "bake/fibres/fit_nurbs.hpp"

#include "frontalis/error.hpp"

#include <Eigen/Cholesky>

namespace frontalis
{
namespace
{

/// Fits the control points of a tensor-product surface by least squares. A small bending stiffness determines the
/// surface where there are no data.
class SurfaceFit
{
public:
  SurfaceFit(const SplineAxis& first, const SplineAxis& second)
      : axes_{ { first, second } },
        matrix_(Eigen::MatrixXd::Zero(first.points() * second.points(), first.points() * second.points())),
        load_(Eigen::MatrixXd::Zero(first.points() * second.points(), 3))
  {
  }

  void add(const std::array<double, 2>& parameter, const Vector3d& target, double weight)
  {
    const Terms terms = basis(parameter);
    for (std::size_t i = 0; i < terms.count; ++i)
    {
      for (std::size_t j = 0; j < terms.count; ++j)
        matrix_(terms.index[i], terms.index[j]) += weight * terms.value[i] * terms.value[j];
      load_.row(terms.index[i]) += weight * terms.value[i] * target.transpose();
    }
  }

  void solve(double stiffness)
  {
    const double scale = stiffness * matrix_.trace() / static_cast<double>(matrix_.rows());
    for (std::size_t a = 0; a < 2; ++a)
    {
      const int n = axes_[a].points(), across = axes_[1 - a].points();
      for (int j = 0; j < across; ++j)
        for (int i = axes_[a].closed() ? 0 : 1; i < (axes_[a].closed() ? n : n - 1); ++i)
        {
          const Eigen::Index at[3] = { place(a, (i + n - 1) % n, j), place(a, i, j), place(a, (i + 1) % n, j) };
          const double second[3] = { 1, -2, 1 };
          for (int p = 0; p < 3; ++p)
            for (int q = 0; q < 3; ++q)
              matrix_(at[p], at[q]) += scale * second[p] * second[q];
        }
    }
    const Eigen::MatrixXd solution = matrix_.ldlt().solve(load_);
    if (!solution.allFinite())
      throw Error("no surface can be fitted around it");
    points_.clear();
    for (Eigen::Index i = 0; i < solution.rows(); ++i)
      points_.emplace_back(solution.row(i));
    matrix_.setZero();
    load_.setZero();
  }

  const std::vector<Vector3d>& points() const { return points_; }

  Vector3d at(const std::array<double, 2>& parameter) const
  {
    const Terms terms = basis(parameter);
    Vector3d sum{ 0, 0, 0 };
    for (std::size_t i = 0; i < terms.count; ++i)
      sum += terms.value[i] * points_[terms.index[i]];
    return sum;
  }

private:
  Eigen::Index place(std::size_t axis, int i, int j) const
  {
    return axis == 0 ? i * axes_[1].points() + j : j * axes_[1].points() + i;
  }
  /// The control points that influence a point of the surface, and their basis functions there.
  struct Terms
  {
    std::size_t count = 0;
    std::array<Eigen::Index, 16> index;
    std::array<double, 16> value;
  };
  Terms basis(const std::array<double, 2>& parameter) const
  {
    const SplineAxis::Basis a = axes_[0].at(parameter[0]), b = axes_[1].at(parameter[1]);
    Terms terms;
    for (int i = 0; i <= axes_[0].degree(); ++i)
      for (int j = 0; j <= axes_[1].degree(); ++j, ++terms.count)
      {
        terms.index[terms.count] = place(0, a.point[i], b.point[j]);
        terms.value[terms.count] = a.value[i] * b.value[j];
      }
    return terms;
  }

  std::array<SplineAxis, 2> axes_;
  Eigen::MatrixXd matrix_, load_;
  std::vector<Vector3d> points_;
};

/// Surface through the middle of the muscle as a function of (u, v), fitted to the centres of the cells.
SurfaceFit middle_sheet(const MuscleGrid& grid, const FibreCoordinates& coordinates, const SplineAxis& along)
{
  SurfaceFit sheet(along, SplineAxis(3, 6, false));
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    sheet.add(coordinates.cells[c], grid.cell_centre(c), 1);
  sheet.solve(0.01);
  return sheet;
}

struct SheetFrame
{
  Vector3d tangent, normal;  ///< unit vectors along u and normal to the sheet
};

SheetFrame sheet_frame(const SurfaceFit& sheet, double u, double v)
{
  // Finite differences, one-sided at the sheet's edges.
  constexpr double step = 0.02;
  const double v0 = std::max(0.0, v - step), v1 = std::min(1.0, v + step);
  const Vector3d tangent = (sheet.at({ u + step, v }) - sheet.at({ u - step, v })).normalized();
  return { tangent, (tangent.cross(sheet.at({ u, v1 }) - sheet.at({ u, v0 }))).normalized() };
}

}  // namespace

NurbsVolume fit_nurbs(const MuscleGrid& grid, const FibreCoordinates& coordinates, bool ring)
{
  const SplineAxis along(3, ring ? 20 : 10, ring);
  const SplineAxis around(3, 12, true);
  const SurfaceFit sheet = middle_sheet(grid, coordinates, along);

  // The second parameter runs around the muscle: from 0 to 1/2 on one side of the sheet, then to 1 on the other.
  struct Datum
  {
    std::array<double, 2> parameter;
    const MuscleGrid::Sample* sample;
    Vector3d middle;
  };
  std::vector<Datum> data;
  const std::size_t stride = grid.samples.size() / 8000 + 1;
  for (std::size_t s = 0; s < grid.samples.size(); s += stride)
  {
    const MuscleGrid::Sample& sample = grid.samples[s];
    if (sample.cell < 0)
      continue;
    const auto [u, v] = coordinates.samples[s];
    const SheetFrame frame = sheet_frame(sheet, u, v);
    // The ends of the muscle are left out, because the surface runs across the fibres there.
    if (std::abs(frame.tangent.dot(sample.normal)) > 0.7)
      continue;
    const Vector3d middle = sheet.at({ u, v });
    const double side = (sample.point - middle).dot(frame.normal);
    const double angle = std::acos(1 - 2 * v) / (2 * pi);
    data.push_back({ { u, side >= 0 ? angle : 1 - angle }, &sample, middle });
  }
  SurfaceFit surface(along, around);
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    for (const Datum& datum : data)
    {
      const MuscleGrid::Sample& sample = *datum.sample;
      double weight = sample.area;
      if (iteration > 0)
      {
        const Vector3d fitted = surface.at(datum.parameter);
        weight *= (sample.point - fitted).dot(fitted - datum.middle) >= 0 ? 1 : 0.2;
      }
      surface.add(datum.parameter, sample.point, weight);
    }
    surface.solve(0.01);
  }

  // Inner control points are means of opposite control points of the outer surface.
  std::vector<Vector3d> points;
  const int n = around.points();
  for (int i = 0; i < along.points(); ++i)
    for (int j = 0; j < n; ++j)
    {
      const Vector3d& outer = surface.points()[i * n + j];
      const Vector3d& opposite = surface.points()[i * n + (n - j) % n];
      points.push_back(0.5 * (outer + opposite));
      points.push_back(outer);
    }
  return NurbsVolume({ { along, around, SplineAxis(1, 2, false) } }, points);
}

// Closed mesh of the volume's outer surface, with caps at its ends unless it is a ring.
static TriangleMesh outer_surface(const NurbsVolume& volume)
{
  const bool ring = volume.axes()[0].closed();
  constexpr std::int32_t along = 48, around = 36;
  const std::int32_t rows = ring ? along : along + 1;
  TriangleMesh mesh;
  for (std::int32_t i = 0; i < rows; ++i)
    for (std::int32_t j = 0; j < around; ++j)
      mesh.vertices.push_back(
          to_array(volume.at({ static_cast<double>(i) / along, static_cast<double>(j) / around, 1 }).position));
  const auto vertex = [&](std::int32_t i, std::int32_t j) { return (i % rows) * around + j % around; };
  for (std::int32_t i = 0; i < along; ++i)
    for (std::int32_t j = 0; j < around; ++j)
    {
      mesh.triangles.push_back({ vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1) });
      mesh.triangles.push_back({ vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1) });
    }
  // Caps at the ends: strips that connect opposite points of the outline.
  for (std::int32_t j = 0; !ring && j < around / 2; ++j)
    for (const std::int32_t i : { 0, along })
    {
      const std::int32_t a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i, around - j - 1),
                         d = vertex(i, around - j);
      for (const Triangle& t : { Triangle{ a, b, c }, Triangle{ a, c, d } })
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
          mesh.triangles.push_back(i == 0 ? t : Triangle{ t[0], t[2], t[1] });
    }
  if (signed_volume(mesh) < 0)
    flip(mesh);
  return mesh;
}

NurbsFit measure_fit(const NurbsVolume& volume, const MuscleGrid& grid, const TriangleTree& muscle)
{
  const TriangleMesh mesh = outer_surface(volume);
  const TriangleTree tree(mesh);
  NurbsFit fit;
  fit.volume = signed_volume(mesh);
  std::size_t within = 0, all = 0;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3d p = grid.cell_centre(c);
    if (muscle.winding_number(p) <= 0.5)
      continue;
    ++all;
    within += tree.winding_number(p) > 0.5 ? 1 : 0;
  }
  fit.enclosed = all > 0 ? static_cast<double>(within) / static_cast<double>(all) : 0;
  double squares = 0, area = 0;
  const std::size_t stride = grid.samples.size() / 1000 + 1;
  for (std::size_t s = 0; s < grid.samples.size(); s += stride)
  {
    const MuscleGrid::Sample& sample = grid.samples[s];
    const double distance = tree.closest(sample.point).distance;
    squares += sample.area * distance * distance;
    area += sample.area;
  }
  fit.distance = std::sqrt(squares / area);
  return fit;
}

}  // namespace frontalis
