#include "bake/fibres/fibre_coordinates.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <vector>

namespace frontalis
{
namespace
{

/// Cells seen along an axis, as a picture whose pixels have the cells' edge; two pixels of border.
struct Picture
{
  Vector3 origin, x, y;
  double edge = 0;
  int width = 0, height = 0;
  std::vector<int> pixels;  ///< 1: muscle, 0: not known yet, -1: outside, 2..: number of a hole

  int& at(int i, int j) { return pixels[static_cast<std::size_t>(j * width + i)]; }
};

Vector3 vector_of(const Eigen::Vector3d& v) { return { v(0), v(1), v(2) }; }

Picture take_picture(const MuscleGrid& grid, const Eigen::Matrix3d& axes, const Vector3& centre)
{
  Picture picture;
  picture.x = vector_of(axes.col(1));
  picture.y = vector_of(axes.col(2));
  picture.edge = grid.edge;
  double low[2] = { 1e300, 1e300 }, high[2] = { -1e300, -1e300 };
  std::vector<std::array<double, 2>> places;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3 d = grid.cell_centre(c) - centre;
    places.push_back({ dot(d, picture.x), dot(d, picture.y) });
    for (std::size_t a = 0; a < 2; ++a)
    {
      low[a] = std::min(low[a], places.back()[a]);
      high[a] = std::max(high[a], places.back()[a]);
    }
  }
  picture.origin = centre + (low[0] - 2 * grid.edge) * picture.x + (low[1] - 2 * grid.edge) * picture.y;
  picture.width = static_cast<int>((high[0] - low[0]) / grid.edge) + 5;
  picture.height = static_cast<int>((high[1] - low[1]) / grid.edge) + 5;
  picture.pixels.assign(static_cast<std::size_t>(picture.width * picture.height), 0);
  // a cell covers a turned square, about its four nearest pixels
  for (const auto& place : places)
    for (int k = 0; k < 4; ++k)
      picture.at(static_cast<int>((place[0] - low[0]) / grid.edge + 1.5) + (k & 1),
                 static_cast<int>((place[1] - low[1]) / grid.edge + 1.5) + (k >> 1)) = 1;
  return picture;
}

/// Marks what is connected to a pixel and returns its pixels.
std::vector<std::array<int, 2>> flood(Picture& picture, int i, int j, int mark)
{
  std::vector<std::array<int, 2>> region{ { i, j } };
  picture.at(i, j) = mark;
  for (std::size_t front = 0; front < region.size(); ++front)
  {
    for (int k = 0; k < 4; ++k)
    {
      const int p = region[front][0] + (k == 0) - (k == 1), q = region[front][1] + (k == 2) - (k == 3);
      if (p < 0 || q < 0 || p >= picture.width || q >= picture.height || picture.at(p, q) != 0)
        continue;
      picture.at(p, q) = mark;
      region.push_back({ p, q });
    }
  }
  return region;
}

}  // namespace

std::optional<RingHole> find_hole(const MuscleGrid& grid)
{
  Vector3 centre{ 0, 0, 0 };
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    centre = centre + (1.0 / static_cast<double>(grid.cells.size())) * grid.cell_centre(c);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3 d = grid.cell_centre(c) - centre;
    const Eigen::Vector3d e(d[0], d[1], d[2]);
    covariance += e * e.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Picture picture = take_picture(grid, solver.eigenvectors(), centre);

  flood(picture, 0, 0, -1);
  std::vector<std::array<int, 2>> hole;
  std::size_t inside = 0;
  int mark = 2;
  for (int j = 0; j < picture.height; ++j)
    for (int i = 0; i < picture.width; ++i)
    {
      if (picture.at(i, j) == 0)
      {
        auto region = flood(picture, i, j, mark++);
        inside += region.size();
        if (region.size() > hole.size())
          hole = std::move(region);
      }
      else if (picture.at(i, j) == 1)
        ++inside;
    }
  if (static_cast<double>(hole.size()) < 0.05 * static_cast<double>(inside))
    return {};

  // its innermost place
  const int own = picture.at(hole.front()[0], hole.front()[1]);
  std::array<int, 2> innermost = hole.front();
  int farthest = -1;
  for (const auto& pixel : hole)
  {
    int nearest = 1 << 30;
    for (int j = 0; j < picture.height; ++j)
      for (int i = 0; i < picture.width; ++i)
      {
        const int squared = (i - pixel[0]) * (i - pixel[0]) + (j - pixel[1]) * (j - pixel[1]);
        if (squared < nearest && picture.at(i, j) != own)
          nearest = squared;
      }
    if (nearest > farthest)
    {
      farthest = nearest;
      innermost = pixel;
    }
  }
  RingHole result;
  result.axis = vector_of(solver.eigenvectors().col(0));
  result.centre = picture.origin + picture.edge * (innermost[0] * picture.x + innermost[1] * picture.y);
  return result;
}

}  // namespace frontalis
