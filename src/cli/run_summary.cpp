#include "cli/run_summary.hpp"

#include "frontalis/study/table.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

namespace frontalis
{
namespace
{

double ratio(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 0; }

double hourglass_share(const Monitor& monitor)
{
  return ratio(monitor.hourglass, monitor.internal + monitor.hourglass);
}

double updates_a_second(const Model& model, const Profile& profile)
{
  return ratio(static_cast<double>(model.voxels.size()) * static_cast<double>(profile.steps), profile.stepping);
}

// motion of a landmark in the face frame [mm]: forward (x), left (y), up (z)
std::array<double, 3> motion_of(const RunSummary& summary, std::size_t landmark)
{
  std::array<double, 3> motion{};
  for (std::size_t i = 0; i < 3; ++i)
    motion[i] = 1e3 * (static_cast<double>(summary.end.landmarks[landmark][i]) - summary.rest.landmarks[landmark][i]);
  return motion;
}

// JSON has no number for what is not finite
std::string json_number(double value)
{
  if (!std::isfinite(value))
    return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// terms of the ledger by name [J]
std::vector<std::pair<const char*, double>> terms_of(const EnergyLedger& l)
{
  return { { "initial", l.initial },     { "kinetic", l.kinetic },       { "internal", l.internal },
           { "hourglass", l.hourglass }, { "viscous", l.viscous },       { "damping", l.damping },
           { "friction", l.friction },   { "muscle", l.muscle },         { "load", l.load },
           { "gravity", l.gravity },     { "constraint", l.constraint }, { "imbalance", l.imbalance() } };
}

}  // namespace

void print_set_up(const Model& model, const RunSummary& summary)
{
  std::printf("backend            %s\n", summary.backend.c_str());
  std::printf("voxels             %zu of %g x %g x %g mm\n", model.voxels.size(), model.spacing[0] * 1e3,
              model.spacing[1] * 1e3, model.spacing[2] * 1e3);
  std::printf("nodes              %zu, of which rigid %zu, sliding %zu\n", model.nodes.size(), model.rigid.size(),
              model.sliding.size());
  std::printf("time step          %.3f us\n", summary.time_step * 1e6);
  std::fflush(stdout);
}

void print_result(const Model& model, const RunSummary& summary)
{
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const std::array<double, 3> motion = motion_of(summary, l);
    std::printf("landmark           %s: %+.3f mm up, %+.3f mm forward, %+.3f mm left\n", model.landmarks[l].c_str(),
                motion[2], motion[0], motion[1]);
  }
  std::printf("kinetic/internal   %.3g at the end, %.3g peak over peak\n",
              ratio(summary.monitor.kinetic, summary.monitor.internal),
              ratio(summary.peak_kinetic, summary.peak_internal));
  std::printf("hourglass share    %.3g of the elastic energy at the end\n", hourglass_share(summary.monitor));
  std::printf("worst J            %.4f at the end, %.4f in the run\n", summary.monitor.worst_jacobian,
              summary.worst_jacobian);
  if (summary.ledger)
  {
    for (const auto& [name, joules] : terms_of(*summary.ledger))
      std::printf("energy             %-10s %+.5e J\n", name, joules);
    std::printf("energy balance     closes within %.3g %% of the largest term\n",
                100 * ratio(std::abs(summary.ledger->imbalance()), summary.ledger->largest));
  }
  if (summary.guard)
    std::printf("guard              %lld checks, went back %lld times%s%s\n",
                static_cast<long long>(summary.guard->checks), static_cast<long long>(summary.guard->rollbacks),
                summary.guard->rollbacks > 0 ? ", the last because " : "",
                summary.guard->rollbacks > 0 ? words_for(summary.guard->latest).c_str() : "");
  if (summary.equilibrium)
    std::printf("equilibrium        %s: %.2e of the displacement is left\n",
                summary.equilibrium->reached ? "reached" : "not reached", summary.equilibrium->residual);
  std::printf("simulated          %.4f s in %lld steps, %.3f us the last\n", summary.seconds,
              static_cast<long long>(summary.profile.steps), summary.time_step * 1e6);
  std::printf("wall               %.3f s: stepping %.3f, skin %.3f, energies %.3f", summary.wall,
              summary.profile.stepping, summary.profile.skin, summary.profile.monitor);
  if (summary.guard)
    std::printf(", guard %.3f", summary.guard->seconds);
  std::printf("\n");
  std::printf("real-time factor   %.4f", ratio(summary.seconds, summary.wall));
  if (model.time_scaling != 1)
    std::printf(" with time scaling %g, which is not real time; %.4f without", model.time_scaling,
                ratio(summary.seconds / model.time_scaling, summary.wall));
  std::printf("\nelement updates    %.2f million a second\n", updates_a_second(model, summary.profile) * 1e-6);
  if (!summary.complete)
    std::printf("the run was interrupted: these are the figures up to there\n");
}

std::string json_of(const Model& model, const RunSummary& summary)
{
  std::string json = "{\n";
  const auto add = [&json](const std::string& key, const std::string& value)
  { json += (json.size() > 2 ? ",\n  " : "  ") + json_string(key) + ": " + value; };
  const auto add_count = [&add](const std::string& key, std::size_t value) { add(key, std::to_string(value)); };

  add("complete", summary.complete ? "true" : "false");
  if (!summary.failure.empty())
    add("failure", json_string(summary.failure));
  add("backend", json_string(summary.backend));
  add_count("voxels", model.voxels.size());
  add_count("nodes", model.nodes.size());
  add_count("rigid_nodes", model.rigid.size());
  add_count("sliding_nodes", model.sliding.size());
  add("scene_hash", json_string(model.scene_hash));
  add("time_scaling", json_number(model.time_scaling));
  add("time_step_s", json_number(summary.time_step));
  add_count("steps", static_cast<std::size_t>(summary.profile.steps));
  add_count("frames", static_cast<std::size_t>(summary.frames));
  add("simulated_s", json_number(summary.seconds));
  std::string landmarks;
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const std::array<double, 3> motion = motion_of(summary, l);
    landmarks += (l == 0 ? "\n    " : ",\n    ") + json_string(model.landmarks[l]) +
                 ": {\"forward_mm\": " + json_number(motion[0]) + ", \"left_mm\": " + json_number(motion[1]) +
                 ", \"up_mm\": " + json_number(motion[2]) + "}";
  }
  add("landmarks", "{" + landmarks + (landmarks.empty() ? "}" : "\n  }"));
  add("kinetic_J", json_number(summary.monitor.kinetic));
  add("internal_J", json_number(summary.monitor.internal));
  add("hourglass_J", json_number(summary.monitor.hourglass));
  add("kinetic_over_internal", json_number(ratio(summary.monitor.kinetic, summary.monitor.internal)));
  add("peak_kinetic_over_peak_internal", json_number(ratio(summary.peak_kinetic, summary.peak_internal)));
  add("hourglass_share", json_number(hourglass_share(summary.monitor)));
  if (summary.ledger)
    for (const auto& [name, joules] : terms_of(*summary.ledger))
      add(std::string("ledger_") + name + "_J", json_number(joules));
  if (summary.guard)
  {
    add_count("guard_checks", static_cast<std::size_t>(summary.guard->checks));
    add_count("guard_rollbacks", static_cast<std::size_t>(summary.guard->rollbacks));
    add("guard_s", json_number(summary.guard->seconds));
  }
  if (summary.equilibrium)
  {
    add("equilibrium_reached", summary.equilibrium->reached ? "true" : "false");
    add("equilibrium_residual", json_number(summary.equilibrium->residual));
  }
  add("worst_jacobian", json_number(summary.worst_jacobian));
  add("wall_s", json_number(summary.wall));
  add("stepping_s", json_number(summary.profile.stepping));
  add("real_time_factor", json_number(ratio(summary.seconds, summary.wall)));
  add("element_updates_per_s", json_number(updates_a_second(model, summary.profile)));
  return json + "\n}\n";
}

}  // namespace frontalis
