// the settings that a study measures, and their names

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// rounded to three digits, enough for a target of the time step
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
  return a.kind == b.kind && a.factor == b.factor && a.materials == b.materials && a.time_step == b.time_step;
}

std::string text_of(const MassScaling& scaling)
{
  if (scaling.kind == MassScaling::Kind::none)
    return "no mass scaling";
  if (scaling.kind == MassScaling::Kind::uniform)
    return "mass ×" + readable(scaling.factor, 3);
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

template <class T, class Set>
Sweep sweep(const std::string& knob, const AccuracySetting& standard, const std::vector<T>& values, Set&& set)
{
  Sweep out{ knob, {} };
  for (const T& value : values)
  {
    out.settings.push_back(standard);
    set(out.settings.back(), value);
  }
  return out;
}

}  // namespace

std::vector<std::string> knob_names()
{
  return { "voxel",     "samples",      "fill_min", "hourglass",    "integration", "precision", "share",
           "time_step", "mass_scaling", "poisson",  "time_scaling", "backend",     "profiles" };
}

std::vector<Sweep> knob_sweeps(const AccuracyPlan& plan, double critical)
{
  const AccuracySetting& s = plan.standard;
  const bool quick = plan.quick;
  using Numbers = std::vector<double>;
  using Names = std::vector<std::string>;
  std::vector<Sweep> all;
  // without a closed form, the last edge is the reference's: no variant has it
  all.push_back(sweep("voxel", s, Numbers(plan.edges.begin(), plan.edges.end() - (plan.exact ? 0 : 1)),
                      [](auto& setting, double edge) { setting.profile.voxel.fill(edge); }));
  all.push_back(sweep("samples", s, quick ? Numbers{ 2, 8 } : Numbers{ 1, 2, 8 },
                      [](auto& setting, double n) { setting.profile.samples = static_cast<int>(n); }));
  all.push_back(sweep("fill_min", s, quick ? Numbers{ 0.05, 0.4 } : Numbers{ 0.02, 0.1, 0.3, 0.5 },
                      [](auto& setting, double share) { setting.profile.fill_min = share; }));
  all.push_back(sweep("hourglass", s, Names{ "scalar", "assumed_strain" },
                      [](auto& setting, const auto& form) { setting.profile.assumed_strain = form != "scalar"; }));
  all.push_back(sweep("integration", s, Names{ "one_point", "selective_reduced" },
                      [](auto& setting, const auto& form) { setting.profile.integration = form; }));
  // the GPU computes in single precision whatever the setting says
  all.push_back(sweep("precision", s, s.backend == "cuda" ? Names{} : Names{ "single", "compensated", "double" },
                      [](auto& setting, const auto& precision) { setting.profile.precision = precision; }));
  all.push_back(sweep("share", s, quick ? Numbers{ 0.45 } : Numbers{ 0.3, 0.6, 0.95 },
                      [](auto& setting, double share) { setting.profile.time_step_share = share; }));
  all.push_back(sweep("time_step", s, Names{ "element", "assembled" },
                      [](auto& setting, const auto& form) { setting.profile.time_step = form; }));
  all.push_back(sweep("mass_scaling", s, quick ? Numbers{ 1, 4, 8 } : Numbers{ 1, 2, 3, 4, 6, 8 },
                      [critical](auto& setting, double factor) { scale_mass(setting, factor, critical); }));
  all.push_back(sweep("poisson", s, Numbers{ 0.45, 0.49, 0.499 },
                      [](auto& setting, double poisson) { setting.poisson = poisson; }));
  all.push_back(sweep("time_scaling", s, quick ? Numbers{ 2, 4 } : Numbers{ 2, 4, 8 },
                      [](auto& setting, double factor) { setting.time_scaling = factor; }));
  std::vector<Backend> backends = available_backends();
  if (quick)
    backends.erase(std::remove(backends.begin(), backends.end(), "reference"), backends.end());
  all.push_back(
      sweep("backend", s, backends, [](auto& setting, const Backend& backend) { setting.backend = backend; }));
  all.push_back(sweep("profiles", s, plan.profiles, [](auto& setting, const auto& p) { setting.profile = p; }));
  return all;
}

std::vector<AccuracySetting> combinations(const AccuracyPlan& plan, double edge, double critical)
{
  std::vector<AccuracySetting> all;
  for (const bool assumed_strain : { false, true })
    for (const char* const form : { "element", "assembled" })
      for (const double factor : { 0, 4, 8 })  // 0: mass as the standard setting has it
      {
        AccuracySetting setting = plan.standard;
        setting.profile.voxel.fill(edge);
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
  profile.voxel.fill(edge);
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
  add(p.time_step_share != s.time_step_share, readable(p.time_step_share, 3) + " of the step");
  add(!same(p.mass_scaling, s.mass_scaling), text_of(p.mass_scaling));
  add(setting.poisson != standard.poisson, "Poisson " + readable(setting.poisson, 4));
  add(setting.time_scaling != standard.time_scaling, "time ×" + readable(setting.time_scaling, 3));
  add(setting.backend != standard.backend, setting.backend);
  return name.empty() ? "standard" : name;
}

double relative_time(const AccuracySetting& setting)
{
  const AccuracyProfile& p = setting.profile;
  double time = 1 / (p.voxel[0] * p.voxel[1] * p.voxel[2] * std::min({ p.voxel[0], p.voxel[1], p.voxel[2] }));
  time *= 0.9 / p.time_step_share / setting.time_scaling;
  time *= p.integration == "selective_reduced" ? 2.5 : p.assumed_strain ? 1.4 : 1;
  time *= p.precision == "double" ? 2 : 1;
  time *= p.mass_scaling.kind == MassScaling::Kind::none ? 1 : 0.3;
  if (setting.poisson > 0.495)
    time *= 3;
  return time * (setting.backend == "reference" ? 30 : 1);
}

}  // namespace frontalis
