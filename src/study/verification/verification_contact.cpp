// contact with rigid bodies: a sphere on a layer

#include "frontalis/model/sample_field.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double pi = 3.14159265358979323846;

// Force on a rigid sphere pressed into an elastic layer that is bonded to a rigid ground, without friction: Hertz with
// the factor of Dimitriadis et al., Biophysical Journal 82, 2002. chi: contact radius of Hertz over thickness.
double layer_factor(double poisson, double chi)
{
  const double a = -(1.2876 - 1.4678 * poisson + 1.3442 * poisson * poisson) / (1 - poisson);
  const double b = (0.6387 - 1.0277 * poisson + 1.5164 * poisson * poisson) / (1 - poisson);
  return 1 - 2 * a / pi * chi + 4 * a * a / (pi * pi) * chi * chi -
         8 / std::pow(pi, 3) * (a * a * a + 4 * pi * pi / 15 * b) * std::pow(chi, 3) +
         16 * a / std::pow(pi, 4) * (a * a * a + 3 * pi * pi / 5 * b) * std::pow(chi, 4);
}

double hertz_force(double young, double poisson, double radius, double depth)
{
  return 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(radius * depth) * depth;
}

// The upper side of a model of whole voxels, four triangles per voxel.
void touch_with_top(Contact& contact, const Model& model)
{
  const std::int32_t nx = model.size[0], ny = model.size[1], top = (model.size[2] - 1) * ny * nx;
  TriangleMesh mesh;
  Binding binding;
  const auto add = [&](double x, double y)
  {
    const auto i = std::min(static_cast<std::int32_t>(x), nx - 1), j = std::min(static_cast<std::int32_t>(y), ny - 1);
    mesh.vertices.push_back({ { x * model.spacing[0], y * model.spacing[1], model.size[2] * model.spacing[2] } });
    binding.voxel.push_back(top + j * nx + i);
    binding.coordinates.push_back({ { static_cast<float>(x - i), static_cast<float>(y - j), 1 } });
  };
  for (std::int32_t j = 0; j <= ny; ++j)
    for (std::int32_t i = 0; i <= nx; ++i)
      add(i, j);
  for (std::int32_t j = 0; j < ny; ++j)
    for (std::int32_t i = 0; i < nx; ++i)
    {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
      add(i + 0.5, j + 0.5);
      for (const auto& edge : { std::array<std::int32_t, 2>{ { a, b } }, { { b, d } }, { { d, c } }, { { c, a } } })
        mesh.triangles.push_back({ { edge[0], edge[1], middle } });
    }
  set_points(contact, mesh, binding);
}

}  // namespace

void verify_hertz(const Backend& backend, Finding& finding)
{
  // a quarter of the layer; lengths in voxels: contact radius, thickness, half of the width
  constexpr std::int32_t contact_radius = 8, thickness = 24, width = 40;
  constexpr double edge = 0.5e-3, young = 34e3, poisson = 0.3, density = 1000;
  const double radius = contact_radius * edge / 0.1, depth = 0.1 * contact_radius * edge;
  Model model = voxel_model({ { width, width, thickness } }, edge, neo_hookean(young, poisson, density));
  model.hourglass = HourglassControl::assumed_strain;
  for (const int axis : { 0, 1 })
    prescribe(model, nodes_where(model, [&](const auto& p) { return p[axis] == 0; }),
              { { axis == 0, axis == 1, false } });
  hold(model, [](const auto& p) { return p[2] == 0; });
  model.bones = { "sphere" };
  Contact contact;
  contact.name = "sphere";
  contact.bone = 0;
  contact.field = sphere_field({ { 0, 0, thickness * edge + radius } }, radius);
  touch_with_top(contact, model);
  model.contacts.push_back(contact);
  EquilibriumSettings search;
  search.backend = backend;
  search.period = 4 * thickness * edge * std::sqrt(density / shear_modulus(young, poisson));
  search.bone_pose.translation[2] = -depth;
  const RestState state = find_equilibrium(model, search);
  const double force = 4 * state.solver->reactions()[0].force[2];
  const double half_space = hertz_force(young, poisson, radius, depth);
  finding.checks.relative("force on the sphere", "N",
                          half_space * layer_factor(poisson, contact_radius / double(thickness)), force, 0.05);
  finding.checks.relative("the same on a half-space", "N", half_space, force, std::nan(""));
  // in the middle, tissue is as deep as the sphere, minus the penetration
  const auto middle =
      nodes_where(model, [&](const auto& p) { return p[0] == 0 && p[1] == 0 && p[2] > (thickness - 0.5) * edge; });
  finding.checks.absolute("depth of the middle below the sphere, in voxels", "1", 0,
                          (mean_displacement(state.displacements, middle)[2] + depth) / edge, 0.05);
}

}  // namespace frontalis
