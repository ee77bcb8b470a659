// Bodies for studies of accuracy whose deformation is known in closed form.
// - "cantilever" is a bar in plane strain. Its ends are displaced like those of a beam under a force at its tip:
// Timoshenko & Goodier, Theory of Elasticity, article 21, in the form of Augarde & Deeks, Finite Elements in Analysis
// and Design 44 (2008) 595.
// - "stretched_block" is neo-Hookean and stretched to 1.3 times its length, with free sides.
// - "active_bar" is the same block without loads, which a muscle without tension-length relation contracts.
// The stretches of both blocks follow from the derivatives of the strain energy mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J -
// 1)^2. They are uniform, so that voxels represent them exactly.

#include "frontalis/error.hpp"
#include "frontalis/study/accuracy.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double bar_young = 30e3, bar_poisson = 0.3, block_poisson = 0.49;              // young [Pa]
constexpr Point bar_size{ { 16e-3, 4e-3, 8e-3 } }, block_size{ { 16e-3, 8e-3, 8e-3 } };  // [m]
constexpr double bar_ramp = 0.1, bar_hold = 0.05;                                        // [s]

// A box of full voxels. The vertices of its skin (faces y = size and z = size) do not depend on the voxel edge.
Model box_model(const AccuracySetting& setting, const Point& size, double ratio)
{
  const AccuracyProfile& profile = setting.profile;
  VoxelBox box{ {}, profile.voxel, { neo_hookean(bar_young, ratio) } };
  for (int axis = 0; axis < 3; ++axis)
  {
    box.size[axis] = static_cast<std::int32_t>(std::lround(size[axis] / box.spacing[axis]));
    if (std::abs(box.size[axis] * box.spacing[axis] - size[axis]) > 1e-9 * size[axis])
      throw Error("voxels of " + millimetres(profile.voxel[axis]) + " do not fit an edge of " +
                  millimetres(size[axis]));
  }
  Model model = voxel_model(box);
  model.hourglass = profile.assumed_strain ? HourglassControl::assumed_strain : HourglassControl::scalar;
  model.integration = profile.integration == "one_point" ? Integration::one_point : Integration::selective_reduced;
  model.precision = profile.precision == "double"        ? Precision::double_precision
                    : profile.precision == "compensated" ? Precision::compensated
                                                         : Precision::single;
  model.time_step_share = profile.time_step_share;
  model.time_step_estimate = profile.time_step == "assembled" ? TimeStepEstimate::assembled : TimeStepEstimate::element;
  model.damping = 100;
  model.skin = grid_mesh(32, 8, [&](double s, double t) { return Point{ { s * size[0], t * size[1], size[2] } }; });
  const auto side = grid_mesh(32, 8,
                              [&](double s, double t) {
                                return Point{ { s * size[0], size[1], t * size[2] } };
                              });
  const auto before = static_cast<std::int32_t>(model.skin.vertices.size());
  model.skin.vertices.insert(model.skin.vertices.end(), side.vertices.begin(), side.vertices.end());
  for (const auto& t : side.triangles)
    model.skin.triangles.push_back({ { t[0] + before, t[1] + before, t[2] + before } });
  model.skin_binding = bind_points(model, model.skin.vertices);
  return model;
}

// First Piola-Kirchhoff stress [Pa] along the principal axis with stretch `a`; `b` and `c` are the other stretches.
double principal_stress(double a, double b, double c)
{
  const double mu = shear_modulus(bar_young, block_poisson), kappa = bulk_modulus(bar_young, block_poisson);
  const double J = a * b * c, I1 = a * a + b * b + c * c;
  return mu * std::pow(J, -2.0 / 3) * (a - I1 / (3 * a)) + kappa * (J - 1) * J / a;
}

double lateral_stretch(double along)
{
  return zero_between(0.3, 3, [=](double side) { return principal_stress(side, along, side); });
}

ClosedForm closed_form(const std::string& name, std::vector<double> edges,
                       const std::function<Model(const AccuracySetting&)>& make,
                       const std::function<Point(const Point&)>& exact)
{
  ClosedForm form{ name, {}, {} };
  AccuracyPlan& plan = form.plan;
  plan.exact = exact;
  plan.edges = std::move(edges);
  plan.standard.profile.voxel.fill(plan.edges[1]);
  plan.standard.profile.precision = "double";
  plan.knobs = { "voxel", "hourglass", "integration", "precision", "share", "time_step" };
  plan.history = { {}, {}, bar_ramp, bar_hold };
  form.maker.bake = make;
  form.maker.content = [name](const AccuracySetting& setting)
  {
    AccuracyRow row;
    row.setting = setting;
    return name + profile_text(row, name, "");
  };
  return form;
}

// A block that `drive` stretches uniformly along x; `along` is its length divided by the length at rest.
ClosedForm uniform(const std::string& name, double along, const std::function<void(Model&)>& drive)
{
  const auto make = [drive](const AccuracySetting& setting)
  {
    Model model = box_model(setting, block_size, block_poisson);
    hold_mirror_planes(model);
    drive(model);
    return model;
  };
  const auto exact = [=, side = lateral_stretch(along)](const Point& p) {
    return Point{ { (along - 1) * p[0], (side - 1) * p[1], (side - 1) * p[2] } };
  };
  return closed_form(name, { 4e-3, 2e-3, 1e-3 }, make, exact);
}

// Displacement [m] of a beam in plane strain (x, z), whose end a shear force lowers by a thousandth of the length.
Point beam(const Point& p)
{
  const double L = bar_size[0], D = bar_size[2], x = p[0], z = p[2] - 0.5 * D, nu = bar_poisson / (1 - bar_poisson);
  const double factor = -1e-3 * L / ((4 + 5 * nu) * D * D * L / 4 + 2 * L * L * L);
  return { { -factor * z * ((6 * L - 3 * x) * x + (2 + nu) * (z * z - D * D / 4)), 0,
             factor * (3 * nu * z * z * (L - x) + (4 + 5 * nu) * D * D * x / 4 + (3 * L - x) * x * x) } };
}

Model cantilever(const AccuracySetting& setting)
{
  Model model = box_model(setting, bar_size, bar_poisson);
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  const auto ends = [&](const auto& p) { return p[0] == 0 || p[0] > bar_size[0] - 0.5 * model.spacing[0]; };
  for (const auto node : nodes_where(model, ends))
    prescribe(model, { node }, { { true, true, true } }, beam(rest_position(model, static_cast<std::size_t>(node))),
              bar_ramp);
  return model;
}

}  // namespace

std::vector<ClosedForm> closed_forms()
{
  constexpr double drawn = 1.3;
  const double active = shear_modulus(bar_young, block_poisson);
  const auto stress = [=](double along)
  { return principal_stress(along, lateral_stretch(along), lateral_stretch(along)) + active * along; };
  const auto contract = [=](Model& model) { add_muscle(model, Muscle{ "bar", active, false, false }, along_x); };
  ClosedForm bar = uniform("active_bar", zero_between(0.5, 1, stress), contract);
  bar.plan.history.activation = { 1 };
  const auto draw = [](Model& model)
  {
    const auto end = [&](const Point& p) { return p[0] > block_size[0] - 0.5 * model.spacing[0]; };
    prescribe(model, nodes_where(model, end), { { true, false, false } }, { { (drawn - 1) * block_size[0], 0, 0 } },
              bar_ramp);
  };
  return { closed_form("cantilever", { 4e-3, 2e-3, 1e-3, 0.5e-3 }, cantilever, beam),
           uniform("stretched_block", drawn, draw), bar };
}

}  // namespace frontalis
