#include "bake/fibres/fibre_coordinates.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <vector>

namespace frontalis
{
namespace
{

/// Projection of the cells along an axis onto an image with pixels as wide as cells and a border of two pixels.
struct Image
{
  Vector3d origin, x, y;
  double edge = 0;
  int width = 0, height = 0;
  std::vector<int> pixels;  ///< 1: muscle, 0: not known yet, -1: outside, from 2 on: number of a hole

  int& at(int i, int j) { return pixels[j * width + i]; }
};

Image project(const MuscleGrid& grid, const Eigen::Matrix3d& axes, const Vector3d& centre)
{
  Image image;
  image.x = axes.col(1);
  image.y = axes.col(2);
  image.edge = grid.edge;
  double low[2] = { 1e300, 1e300 }, high[2] = { -1e300, -1e300 };
  std::vector<std::array<double, 2>> places;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3d d = grid.cell_centre(c) - centre;
    places.push_back({ d.dot(image.x), d.dot(image.y) });
    for (std::size_t a = 0; a < 2; ++a)
    {
      low[a] = std::min(low[a], places.back()[a]);
      high[a] = std::max(high[a], places.back()[a]);
    }
  }
  image.origin = centre + (low[0] - 2 * grid.edge) * image.x + (low[1] - 2 * grid.edge) * image.y;
  image.width = static_cast<int>((high[0] - low[0]) / grid.edge) + 5;
  image.height = static_cast<int>((high[1] - low[1]) / grid.edge) + 5;
  image.pixels.assign(image.width * image.height, 0);
  // the square that a cell covers is turned against the pixels: mark the four nearest
  for (const auto& place : places)
    for (int k = 0; k < 4; ++k)
      image.at(static_cast<int>((place[0] - low[0]) / grid.edge + 1.5) + (k & 1),
               static_cast<int>((place[1] - low[1]) / grid.edge + 1.5) + (k >> 1)) = 1;
  return image;
}

/// Marks the unknown pixels that are connected to one and returns them.
std::vector<std::array<int, 2>> flood(Image& image, int i, int j, int mark)
{
  std::vector<std::array<int, 2>> region{ { i, j } };
  image.at(i, j) = mark;
  for (std::size_t front = 0; front < region.size(); ++front)
    for (int k = 0; k < 4; ++k)
    {
      const int p = region[front][0] + (k == 0) - (k == 1), q = region[front][1] + (k == 2) - (k == 3);
      if (p < 0 || q < 0 || p >= image.width || q >= image.height || image.at(p, q) != 0)
        continue;
      image.at(p, q) = mark;
      region.push_back({ p, q });
    }
  return region;
}

}  // namespace

std::optional<RingHole> find_hole(const MuscleGrid& grid)
{
  Vector3d centre{ 0, 0, 0 };
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    centre += (1.0 / static_cast<double>(grid.cells.size())) * grid.cell_centre(c);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3d d = grid.cell_centre(c) - centre;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Image image = project(grid, solver.eigenvectors(), centre);

  flood(image, 0, 0, -1);
  std::vector<std::array<int, 2>> hole;
  std::size_t inside = 0;
  int mark = 2;
  for (int j = 0; j < image.height; ++j)
    for (int i = 0; i < image.width; ++i)
    {
      if (image.at(i, j) == 0)
      {
        auto region = flood(image, i, j, mark++);
        inside += region.size();
        if (region.size() > hole.size())
          hole = std::move(region);
      }
      else if (image.at(i, j) == 1)
        ++inside;
    }
  if (static_cast<double>(hole.size()) < 0.05 * static_cast<double>(inside))
    return {};

  // the pixel of the hole that is farthest from its border
  const int own = image.at(hole.front()[0], hole.front()[1]);
  std::array<int, 2> innermost = hole.front();
  int farthest = -1;
  for (const auto& pixel : hole)
  {
    int nearest = 1 << 30;
    for (int j = 0; j < image.height; ++j)
      for (int i = 0; i < image.width; ++i)
      {
        const int squared = (i - pixel[0]) * (i - pixel[0]) + (j - pixel[1]) * (j - pixel[1]);
        if (squared < nearest && image.at(i, j) != own)
          nearest = squared;
      }
    if (nearest > farthest)
    {
      farthest = nearest;
      innermost = pixel;
    }
  }
  RingHole result;
  result.axis = solver.eigenvectors().col(0);
  result.centre = image.origin + image.edge * (innermost[0] * image.x + innermost[1] * image.y);
  return result;
}

}  // namespace frontalis
