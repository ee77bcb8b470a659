#include "backends.hpp"
#include "block_model.hpp"

#include <cmath>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// a roof of two planes that meet in a ridge along y, finely triangulated across
TriangleMesh roof(double slope)
{
  TriangleMesh mesh;
  const double half = 40e-3;
  for (const double y : { -half, half })
    for (const double x : { -half, 0.0, half })
      mesh.vertices.push_back({ { x + 10e-3, y, -slope * std::abs(x) } });
  mesh.triangles = { { { 0, 1, 3 } }, { { 1, 4, 3 } }, { { 1, 2, 4 } }, { { 2, 5, 4 } } };
  return mesh;
}

// exact distance to the roof's surface at p, from above
double roof_distance(double slope, const std::array<double, 3>& p)
{
  const double x = p[0] - 10e-3, length = std::sqrt(1 + slope * slope);
  double best = std::hypot(x, p[2]);
  for (const double side : { -1.0, 1.0 })
  {
    const double along = (side * x - slope * p[2]) / length;
    if (along > 0)
      best = std::min(best, std::abs(slope * side * x + p[2]) / length);
  }
  return best;
}

}  // namespace

class Sliding : public test::EveryBackend
{
};

TEST_P(Sliding, KeepsItsDistanceOverARidge)
{
  const double slope = 0.4;
  test::BlockSettings s;
  s.voxels = { { 8, 2, 2 } };
  s.damping = 50;
  s.young = 3e3;
  Model model = test::block_model(s);
  model.constraint_surfaces.push_back({ "roof", roof(slope) });
  // the underside lies above the roof, which is lowered by 3 mm
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] == 0)
      model.sliding.push_back({ static_cast<std::int32_t>(n), 0, 0 });
  for (auto& vertex : model.constraint_surfaces[0].mesh.vertices)
    vertex[2] -= 3e-3;
  for (auto& node : model.sliding)
  {
    auto p = test::rest(model, node.node);
    p[2] += 3e-3;
    node.distance = roof_distance(slope, p);
  }
  model.gravity = { { 40.0, 0, 0 } };  // drags it along x over the ridge
  const auto solver_ = solver(model);
  double worst = 0, travelled = 0;
  for (int i = 0; i < 40; ++i)
  {
    solver_->advance(2e-3, {});
    Vectors u;
    solver_->displacements(u);
    for (const auto& node : model.sliding)
    {
      auto p = test::rest(model, node.node);
      for (int axis = 0; axis < 3; ++axis)
        p[axis] += u[node.node][axis];
      p[2] += 3e-3;
      worst = std::max(worst, std::abs(roof_distance(slope, p) - node.distance));
      travelled = std::max(travelled, u[node.node][0]);
    }
  }
  EXPECT_GT(travelled, 10e-3);
  EXPECT_LT(worst, 10e-6);
}

FRONTALIS_EVERY_BACKEND(Sliding);
