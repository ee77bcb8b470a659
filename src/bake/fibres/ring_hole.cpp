#include "bake/fibres/fibre_coordinates.hpp"

#include <Eigen/Eigenvalues>

namespace frontalis
{
namespace
{

using Pixel = Eigen::Vector2i;

/// Projection of the cells along an axis. Pixels are as wide as cells; a border of two pixels surrounds the muscle.
struct Image
{
  Vector3d origin, x, y;
  Eigen::ArrayXXi pixels;  ///< 1: muscle, 0: not known yet, -1: outside, 2 or more: index of a hole

  /// Marks and returns an unknown pixel and all unknown pixels connected to it.
  std::vector<Pixel> fill(const Pixel& seed, int mark)
  {
    static const std::vector<Pixel> steps{ { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } };
    const auto take = [&](const Pixel& p)
    {
      const bool taken = p.minCoeff() >= 0 && p[0] < pixels.rows() && p[1] < pixels.cols() && pixels(p[0], p[1]) == 0;
      if (taken)
        pixels(p[0], p[1]) = mark;
      return taken;
    };
    take(seed);
    return flood(seed, steps, take);
  }
};

Image project(const MuscleGrid& grid, const Eigen::Matrix3d& axes, const Vector3d& centre)
{
  Image image;
  image.x = axes.col(1);
  image.y = axes.col(2);
  Eigen::AlignedBox2d box;
  std::vector<Eigen::Vector2d> places;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    const Vector3d d = grid.cell_centre(c) - centre;
    places.emplace_back(d.dot(image.x), d.dot(image.y));
    box.extend(places.back());
  }
  image.origin = centre + (box.min()[0] - 2 * grid.edge) * image.x + (box.min()[1] - 2 * grid.edge) * image.y;
  const Pixel size = (box.sizes() / grid.edge).cast<int>() + Pixel::Constant(5);
  image.pixels.setZero(size[0], size[1]);
  // A projected cell is rotated relative to the pixels, so that the four nearest pixels are marked.
  for (const Eigen::Vector2d& place : places)
  {
    const Pixel corner = ((place - box.min()) / grid.edge + Eigen::Vector2d::Constant(1.5)).cast<int>();
    image.pixels.block<2, 2>(corner[0], corner[1]).setOnes();
  }
  return image;
}

/// The pixel of a hole that is farthest from its border.
Pixel innermost(const Image& image, const std::vector<Pixel>& hole)
{
  const int own = image.pixels(hole.front()[0], hole.front()[1]);
  Pixel best = hole.front();
  int farthest = -1;
  for (const Pixel& pixel : hole)
  {
    int nearest = 1 << 30;
    for (int j = 0; j < image.pixels.cols(); ++j)
      for (int i = 0; i < image.pixels.rows(); ++i)
        if (image.pixels(i, j) != own)
          nearest = std::min(nearest, (Pixel(i, j) - pixel).squaredNorm());
    if (nearest > farthest)
    {
      farthest = nearest;
      best = pixel;
    }
  }
  return best;
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

  image.fill({ 0, 0 }, -1);
  auto inside = static_cast<double>((image.pixels == 1).count());
  std::vector<Pixel> hole;
  int mark = 2;
  for (int j = 0; j < image.pixels.cols(); ++j)
    for (int i = 0; i < image.pixels.rows(); ++i)
    {
      if (image.pixels(i, j) != 0)
        continue;
      auto region = image.fill({ i, j }, mark++);
      inside += static_cast<double>(region.size());
      if (region.size() > hole.size())
        hole = std::move(region);
    }
  if (static_cast<double>(hole.size()) < 0.05 * inside)
    return {};
  const Pixel middle = innermost(image, hole);
  return RingHole{ image.origin + grid.edge * (middle[0] * image.x + middle[1] * image.y),
                   solver.eigenvectors().col(0) };
}

}  // namespace frontalis
