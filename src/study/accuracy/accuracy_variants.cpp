// Lists the settings that a study measures, and names them.

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Rounds to three significant digits, which suffice for the target of a time step.
double rounded(double value)
{
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

void scale_mass(AccuracySetting& setting, double factor, double critical)
{
  setting.profile.mass_scaling = {};
  if (factor == 1)
    return;
  setting.profile.mass_scaling.kind = MassScaling::Kind::selective;
  setting.profile.mass_scaling.time_step = rounded(factor * critical);
}

bool same(const MassScaling& a, const MassScaling& b)
{
  return a.kind == b.kind && a.factor == b.factor && a.materials == b.materials && a.time_step == b.time_step &&
         a.in_motion == b.in_motion;
}

std::string text_of(const MassScaling& scaling)
{
  if (scaling.kind == MassScaling::Kind::none)
    return "no mass scaling";
  if (scaling.kind == MassScaling::Kind::uniform)
    return "mass ×" + readable(scaling.factor, 3) +
           (scaling.in_motion > 0 ? ", in motion for " + readable(1e6 * scaling.in_motion, 3) + " µs" : "");
  std::string text = "mass for";
  if (scaling.time_step > 0)
    text += " " + readable(1e6 * scaling.time_step, 3) + " µs";
  for (const auto& material : scaling.materials)
    text += " " + material;
  return text;
}

std::string edge_text(const Vector3& voxel)
{
  std::string text = readable(1e3 * voxel[0], 4);
  if (voxel[1] != voxel[0] || voxel[2] != voxel[0])
    text += " × " + readable(1e3 * voxel[1], 4) + " × " + readable(1e3 * voxel[2], 4);
  return text + " mm";
}

// Gives voxels another edge along x, and the same proportions as before.
void set_edge(AccuracyProfile& profile, double edge)
{
  const double before = profile.voxel[0];
  if (edge == before)
    return;
  for (double& along : profile.voxel)
    along = along == before ? edge : edge * (along / before);
}

template <class T, class Set>
std::vector<AccuracySetting> sweep(const AccuracySetting& standard, const std::vector<T>& values, Set&& set)
{
  std::vector<AccuracySetting> settings(values.size(), standard);
  for (std::size_t i = 0; i < values.size(); ++i)
    set(settings[i], values[i]);
  return settings;
}

}  // namespace

// The sweeps are in the order of the command line's help.
std::vector<Sweep> knob_sweeps(const AccuracyPlan& plan, double critical)
{
  const AccuracySetting& s = plan.standard;
  const bool quick = plan.quick;
  using Numbers = std::vector<double>;
  using Names = std::vector<std::string>;
  // Without a closed form, the last edge is only for the reference.
  const Numbers edges(plan.edges.begin(), plan.edges.end() - (plan.exact || plan.edges.empty() ? 0 : 1));
  // The GPU always computes in single precision.
  const Names precisions = s.backend == "cuda" ? Names{} : Names{ "single", "compensated", "double" };
  // Bodies with a closed form have no bones.
  const Numbers attached_edges = plan.exact ? Numbers{} : edges;
  std::vector<Backend> backends = available_backends();
  if (quick)
    backends.erase(std::remove(backends.begin(), backends.end(), "reference"), backends.end());
  return { { "voxel", "voxel edge", sweep(s, edges, [](auto& to, double edge) { set_edge(to.profile, edge); }) },
           { "samples", "sampling density",
             sweep(s, quick ? Numbers{ 2, 8 } : Numbers{ 1, 2, 8 },
                   [](auto& to, double n) { to.profile.samples = static_cast<int>(n); }) },
           { "fill_min", "least filling",
             sweep(s, quick ? Numbers{ 0.05, 0.4 } : Numbers{ 0.02, 0.1, 0.3, 0.5 },
                   [](auto& to, double share) { to.profile.fill_min = share; }) },
           { "boundary", "boundary at its place",
             sweep(s, attached_edges,
                   [](auto& to, double edge)
                   {
                     set_edge(to.profile, edge);
                     to.profile.boundary = "true";
                     to.profile.fill_min = std::min(to.profile.fill_min, 0.05);
                     to.profile.time_step = "assembled";
                   }) },
           { "hourglass", "hourglass form",
             sweep(s, Names{ "scalar", "assumed_strain" },
                   [](auto& to, const auto& form) { to.profile.assumed_strain = form != "scalar"; }) },
           { "integration", "selective reduced",
             sweep(s, Names{ "one_point", "selective_reduced" },
                   [](auto& to, const auto& form) { to.profile.integration = form; }) },
           { "precision", "precision",
             sweep(s, precisions, [](auto& to, const auto& precision) { to.profile.precision = precision; }) },
           { "share", "share of critical step",
             sweep(s, quick ? Numbers{ 0.45 } : Numbers{ 0.3, 0.6, 0.95 },
                   [](auto& to, double share) { to.profile.time_step_share = share; }) },
           { "time_step", "time step form",
             sweep(s, Names{ "element", "assembled" },
                   [](auto& to, const auto& form) { to.profile.time_step = form; }) },
           { "mass_scaling", "mass scaling",
             sweep(s, quick ? Numbers{ 1, 4, 8 } : Numbers{ 1, 2, 3, 4, 6, 8 },
                   [=](auto& to, double factor) { scale_mass(to, factor, critical); }) },
           { "bulk_modulus_max", "limit of bulk moduli",
             sweep(s, quick ? Numbers{ 0, 250e3 } : Numbers{ 0, 1e6, 500e3, 250e3, 100e3 },
                   [](auto& to, double limit) { to.profile.bulk_modulus_max = limit; }) },
           { "time_scaling", "time scaling",
             sweep(s, quick ? Numbers{ 2, 4 } : Numbers{ 2, 4, 8 },
                   [](auto& to, double factor) { to.time_scaling = factor; }) },
           { "backend", "backend", sweep(s, backends, [](auto& to, const Backend& backend) { to.backend = backend; }) },
           { "profiles", "profiles", sweep(s, plan.profiles, [](auto& to, const auto& p) { to.profile = p; }) } };
}

std::vector<std::string> knob_names()
{
  std::vector<std::string> names;
  for (const Sweep& sweep : knob_sweeps({}, 1))
    names.push_back(sweep.knob);
  return names;
}

std::vector<AccuracySetting> combinations(const AccuracyPlan& plan, double edge, double critical)
{
  std::vector<AccuracySetting> all;
  for (const bool assumed_strain : { false, true })
    for (const char* const form : { "element", "assembled" })
      for (const double factor : { 0, 4, 8 })  // 0: the standard setting's mass scaling
      {
        AccuracySetting setting = plan.standard;
        set_edge(setting.profile, edge);
        setting.profile.assumed_strain = assumed_strain;
        setting.profile.time_step = form;
        if (factor > 0)
          scale_mass(setting, factor, critical * edge / plan.standard.profile.voxel[0]);
        all.push_back(setting);
      }
  return all;
}

AccuracySetting reference_setting(const AccuracySetting& standard, double edge)
{
  AccuracySetting setting = standard;
  AccuracyProfile& profile = setting.profile;
  set_edge(profile, edge);
  profile.assumed_strain = true;
  profile.integration = "one_point";
  profile.time_step = "assembled";
  profile.mass_scaling = {};
  return setting;
}

std::string name_of(const AccuracySetting& setting, const AccuracySetting& standard)
{
  std::string name;
  const auto add = [&name](bool differs, const std::string& words)
  {
    if (differs)
      name += (name.empty() ? "" : ", ") + words;
  };
  const AccuracyProfile &p = setting.profile, &s = standard.profile;
  add(p.voxel != s.voxel, edge_text(p.voxel));
  add(p.samples != s.samples, fmt::to_string(p.samples) + " samples");
  add(p.fill_min != s.fill_min, "fill from " + readable(p.fill_min, 3));
  add(p.assumed_strain != s.assumed_strain, p.assumed_strain ? "assumed strain" : "scalar hourglass");
  add(p.integration != s.integration, p.integration == "one_point" ? "one point" : "selective reduced");
  add(p.precision != s.precision, p.precision);
  add(p.time_step != s.time_step, p.time_step);
  add(p.boundary != s.boundary, "boundary " + p.boundary);
  add(p.gaps != s.gaps, "gaps " + p.gaps);
  add(p.fibres != s.fibres, "fibres " + p.fibres);
  add(p.time_step_share != s.time_step_share, readable(p.time_step_share, 3) + " of the step");
  add(!same(p.mass_scaling, s.mass_scaling), text_of(p.mass_scaling));
  add(p.bulk_modulus_max != s.bulk_modulus_max,
      p.bulk_modulus_max > 0 ? "bulk moduli to " + readable(1e-3 * p.bulk_modulus_max, 4) + " kPa"
                             : "all of the bulk moduli");
  add(setting.time_scaling != standard.time_scaling, "time ×" + readable(setting.time_scaling, 3));
  add(setting.backend != standard.backend, setting.backend);
  return name.empty() ? "standard" : name;
}

double relative_time(const AccuracySetting& setting)
{
  const AccuracyProfile& p = setting.profile;
  // The factors are rough, because they only predict the duration of a study.
  double time = 1 / (p.voxel[0] * p.voxel[1] * p.voxel[2] * std::min({ p.voxel[0], p.voxel[1], p.voxel[2] }));
  time *= 0.9 / p.time_step_share / setting.time_scaling;
  time *= p.integration == "selective_reduced" ? 2.5 : p.assumed_strain ? 1.4 : 1;
  time *= p.precision == "double" ? 2 : 1;
  time *= p.mass_scaling.kind == MassScaling::Kind::none ? 1 : 0.3;
  return time * (setting.backend == "reference" ? 30 : 1);
}

}  // namespace frontalis
