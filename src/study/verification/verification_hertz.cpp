// Contact with rigid bodies: a sphere on a layer.

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/number.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

// Factor of Dimitriadis et al., Biophysical Journal 82, 2002, on the force of Hertz: a rigid sphere is pressed without
// friction into an elastic layer, which is bonded to a rigid ground. chi: Hertz's contact radius divided by the
// thickness of the layer.
double layer_factor(double poisson, double chi)
{
  const double a = -(1.2876 - 1.4678 * poisson + 1.3442 * poisson * poisson) / (1 - poisson);
  const double b = (0.6387 - 1.0277 * poisson + 1.5164 * poisson * poisson) / (1 - poisson);
  return 1 - 2 * a / physics::pi * chi + 4 * a * a / (physics::pi * physics::pi) * chi * chi -
         8 / std::pow(physics::pi, 3) * (a * a * a + 4 * physics::pi * physics::pi / 15 * b) * std::pow(chi, 3) +
         16 * a / std::pow(physics::pi, 4) * (a * a * a + 3 * physics::pi * physics::pi / 5 * b) * std::pow(chi, 4);
}

double hertz_force(double young, double poisson, double radius, double depth)
{
  return 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(radius * depth) * depth;
}

// Lengths in voxels: contact radius, thickness of the layer, half of its width.
constexpr std::int32_t contact_radius = 8, thickness = 24, half_width = 40;
constexpr double hertz_edge = 0.5e-3, hertz_young = 34e3, hertz_poisson = 0.3, hertz_density = 1000;
constexpr double hertz_radius = contact_radius * hertz_edge / 0.1, hertz_depth = 0.1 * contact_radius * hertz_edge;

// Placement of the layer in the grid: rotation about y [degrees], and shifts along x and z [voxels].
struct Placement
{
  std::string name;
  double turn, shift;
};

struct Pressed
{
  double force;      // force on the sphere along its motion [N]
  double shortfall;  // depth of the sphere minus that of the tissue below its middle [m]
};

// Presses the sphere into half of a layer, which is cut at y = 0. The fill of a voxel is the fraction of it that is in
// the layer.
Pressed press(const Placement& placement, const Backend& backend)
{
  const double c = std::cos(placement.turn * physics::pi / 180), s = std::sin(placement.turn * physics::pi / 180);
  const double shift = placement.shift * hertz_edge, length = 2 * half_width * hertz_edge, top = thickness * hertz_edge;
  // Maps coordinates of the layer (ground at z = 0, middle at x = 0) to the grid.
  const auto in_grid = [&](const Point& p) -> Point
  {
    const double x = p[0] + 0.5 * length;
    return { { c * x + s * p[2] + shift, p[1], s * (length - x) + c * p[2] + shift } };
  };
  const auto in_layer = [&](const Point& p) -> Point
  {
    const double x = p[0] - shift, z = p[2] - shift - s * length;
    return { { c * x - s * z - 0.5 * length, p[1], s * x + c * z } };
  };
  const auto voxels = [&](double way) { return static_cast<std::int32_t>(std::ceil(way / hertz_edge + 1e-9)) + 1; };
  VoxelBox box{ { { voxels(c * length + s * top), half_width, voxels(s * length + c * top) } },
                { { hertz_edge, hertz_edge, hertz_edge } },
                { neo_hookean(hertz_young, hertz_poisson, hertz_density) } };
  box.fill = sampled_fill(box.spacing,
                          [&](const Point& p)
                          {
                            const Point q = in_layer(p);
                            return std::abs(q[0]) < 0.5 * length && q[2] > 0 && q[2] < top;
                          });
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  prescribe(model, nodes_where(model, [](const auto& p) { return p[1] == 0; }), { { false, true, false } });
  hold(model, [&](const auto& p) { return in_layer(p)[2] < 0.5 * hertz_edge; });
  model.bones = { "sphere" };
  Contact contact;
  contact.name = "sphere";
  contact.bone = 0;
  contact.field = sphere_field(in_grid({ { 0, 0, top + hertz_radius } }), hertz_radius);
  // The part of the surface that may touch the sphere.
  constexpr int rows = 4 * contact_radius;
  const double reach = 2 * contact_radius * hertz_edge;
  const TriangleMesh surface = grid_mesh(2 * rows, rows,
                                         [&](double t, double u) {
                                           return in_grid({ { reach * (2 * t - 1), reach * u, top } });
                                         });
  set_points(contact, surface, bind_points(model, surface.vertices));
  model.contacts.push_back(contact);
  EquilibriumSettings search;
  search.backend = backend;
  search.period = 4 * top * std::sqrt(hertz_density / shear_modulus(hertz_young, hertz_poisson));
  const Point up{ { s, 0, c } };
  for (std::size_t axis = 0; axis < 3; ++axis)
    search.bone_pose.translation[axis] = -hertz_depth * up[axis];
  const RestState state = find_equilibrium(model, search);
  const auto along = [&](const Point& p) { return p[0] * up[0] + p[2] * up[2]; };
  Pressed pressed{ 2 * along(state.solver->reactions()[0].force), hertz_depth };
  const Point middle = in_grid({ { 0, 0, top } });
  const Binding there = bind_points(model, { middle });
  const auto& at = there.coordinates[0];
  for (std::size_t b = 0; b < 8; ++b)
  {
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      weight *= (b >> axis & 1) != 0 ? double(at[axis]) : 1 - double(at[axis]);
    pressed.shortfall += weight * along(state.displacements[model.voxel_nodes[there.voxel[0]][b]]);
  }
  return pressed;
}

}  // namespace

void verify_hertz(const Backend& backend, Finding& finding)
{
  const double chi = contact_radius / double(thickness);
  const double expected =
      hertz_force(hertz_young, hertz_poisson, hertz_radius, hertz_depth) * layer_factor(hertz_poisson, chi);
  for (const Placement& placement : { Placement{ "along the grid", 0, 0 },
                                      { "shifted by 1/3", 0, 1.0 / 3 },
                                      { "turned by 20°", 20, 0 },
                                      { "turned and shifted", 20, 1.0 / 3 } })
  {
    const Pressed pressed = press(placement, backend);
    finding.checks.relative("force, " + placement.name, "N", expected, pressed.force, 0.05);
    // The shortfall is the penetration that the stiffness of contact allows.
    finding.checks.absolute("sphere deeper than tissue, " + placement.name, "voxels", 0, pressed.shortfall / hertz_edge,
                            0.05);
  }
}

}  // namespace frontalis
