#include "cli/run_output.hpp"

#include "cli/reactions.hpp"
#include "frontalis/model/body_shape.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

double updates_per_second(const Model& model, const Profile& profile)
{
  return ratio(static_cast<double>(model.voxels.size()) * static_cast<double>(profile.steps), profile.stepping);
}

// Motion of a landmark in the face frame [mm]: forward (x), left (y), up (z).
std::array<double, 3> motion_of(const RunSummary& summary, std::size_t landmark)
{
  std::array<double, 3> motion{};
  for (std::size_t i = 0; i < 3; ++i)
    motion[i] = 1e3 * (static_cast<double>(summary.end.landmarks[landmark][i]) - summary.rest.landmarks[landmark][i]);
  return motion;
}

std::vector<std::pair<std::string, double>> energies_of(const EnergyLedger& ledger)
{
  std::vector<std::pair<std::string, double>> energies{ { "initial", ledger.initial } };
  for (const EnergyTerm& term : ledger.terms)
    energies.emplace_back(term.name, term.value);
  energies.emplace_back("imbalance", ledger.imbalance());
  return energies;
}

void print_wrinkles(const Wrinkles& wrinkles)
{
  if (wrinkles.furrows.empty())
    return fmt::print("wrinkles           none\n");
  fmt::print("wrinkles           {} furrows, {:.1f} beside each other, {:.2f} mm deep (at most {:.2f}), {} apart\n",
             wrinkles.furrows.size(), wrinkles.count, 1e3 * wrinkles.depth, 1e3 * wrinkles.deepest,
             wrinkles.spacing > 0 ? fmt::format("{:.1f} mm", 1e3 * wrinkles.spacing) : "none");
  fmt::print("                   along {:+.2f} forward, {:+.2f} left, {:+.2f} up\n", wrinkles.direction[0],
             wrinkles.direction[1], wrinkles.direction[2]);
  for (const Furrow& furrow : wrinkles.furrows)
    fmt::print("furrow             {:.0f} mm long, {:.2f} mm deep, middle {:+.1f} mm left, {:+.1f} mm up\n",
               1e3 * furrow.length, 1e3 * furrow.depth, 1e3 * furrow.middle[1], 1e3 * furrow.middle[2]);
}

nlohmann::ordered_json json_of(const Wrinkles& wrinkles)
{
  auto furrows = nlohmann::ordered_json::array();
  for (const Furrow& furrow : wrinkles.furrows)
    furrows.push_back({ { "length_m", furrow.length }, { "depth_m", furrow.depth }, { "middle_m", furrow.middle } });
  return { { "count", wrinkles.count },       { "depth_m", wrinkles.depth },       { "deepest_m", wrinkles.deepest },
           { "spacing_m", wrinkles.spacing }, { "direction", wrinkles.direction }, { "furrows", furrows } };
}

// Warns of voxels that are turned inside out.
void print_inverted(const Model& model, const Monitor& monitor)
{
  const auto& corners = model.voxel_nodes[static_cast<std::size_t>(monitor.worst_voxel)];
  std::array<double, 3> place{ 0, 0, 0 };
  for (const std::int32_t node : corners)
  {
    const auto corner = model.to_scene(rest_position(model, static_cast<std::size_t>(node)));
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] += 1e3 / 8 * corner[axis];
  }
  const auto held = std::find_if(model.rigid.begin(), model.rigid.end(),
                                 [&](const RigidNode& n)
                                 { return std::find(corners.begin(), corners.end(), n.node) != corners.end(); });
  const bool named = held != model.rigid.end() && held->constraint >= 0;
  fmt::print(
      "warning            {} turned inside out at the end, the worst at ({:.1f}, {:.1f}, {:.1f}) mm in the scene{}\n",
      monitor.inverted == 1 ? "1 voxel is" : fmt::format("{} voxels are", monitor.inverted), place[0], place[1],
      place[2],
      named ? fmt::format(", where constraint '{}' holds tissue: let it glide there, or move the face less",
                          model.constraints[std::size_t(held->constraint)])
            : ": move the face less");
}

}  // namespace

void print_set_up(const Model& model, const RunSummary& summary)
{
  fmt::print("backend            {}\n", summary.backend);
  fmt::print("voxels             {} of {:g} x {:g} x {:g} mm\n", model.voxels.size(), model.spacing[0] * 1e3,
             model.spacing[1] * 1e3, model.spacing[2] * 1e3);
  fmt::print("nodes              {}, of which {}\n", model.nodes.size(), restricted_nodes_text(model));
  fmt::print("time step          {:.3f} us\n", summary.time_step * 1e6);
  std::fflush(stdout);
}

void print_result(const Model& model, const RunSummary& summary)
{
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const std::array<double, 3> motion = motion_of(summary, l);
    fmt::print("landmark           {}: {:+.3f} mm up, {:+.3f} mm forward, {:+.3f} mm left\n", model.landmarks[l],
               motion[2], motion[0], motion[1]);
  }
  fmt::print("kinetic/internal   {:.3g} at the end, {:.3g} peak over peak\n",
             ratio(summary.monitor.kinetic, summary.monitor.internal),
             ratio(summary.peak_kinetic, summary.peak_internal));
  fmt::print("hourglass share    {:.3g} of the elastic energy at the end\n", hourglass_share(summary.monitor));
  fmt::print("worst J            {:.4f} at the end, {:.4f} in the run\n", summary.monitor.worst_jacobian,
             summary.worst_jacobian);
  if (summary.monitor.inverted > 0)
    print_inverted(model, summary.monitor);
  if (summary.monitor.added_mass > 0)
    fmt::print("mass added         {:.2g} % of the model's, for longer steps\n", 100 * summary.monitor.added_mass);
  if (summary.ledger)
  {
    for (const auto& [name, joules] : energies_of(*summary.ledger))
      fmt::print("energy             {:<14} {:+.5e} J\n", name, joules);
    fmt::print("energy balance     closes within {:.3g} % of the largest term\n",
               100 * ratio(std::abs(summary.ledger->imbalance()), summary.ledger->largest));
  }
  print_reactions(model, summary.bodies);
  if (summary.wrinkles)
    print_wrinkles(*summary.wrinkles);
  if (summary.guard)
    fmt::print("guard              {} checks, went back {} times{}\n", summary.guard->checks, summary.guard->rollbacks,
               summary.guard->rollbacks > 0 ? ", the last because " + words_for(summary.guard->latest) : "");
  if (summary.equilibrium)
    fmt::print("equilibrium        {}: {:.2e} of the displacement is left\n",
               summary.equilibrium->reached ? "reached" : "not reached", summary.equilibrium->residual);
  fmt::print("simulated          {:.4f} s in {} steps, {:.3f} us the last\n", summary.seconds, summary.profile.steps,
             summary.time_step * 1e6);
  fmt::print("wall               {:.3f} s: stepping {:.3f}, skin {:.3f}, energies {:.3f}{}\n", summary.wall,
             summary.profile.stepping, summary.profile.skin, summary.profile.monitor,
             summary.guard ? fmt::format(", guard {:.3f}", summary.guard->seconds) : "");
  if (summary.fine_lines > 0)
    fmt::print("fine lines         {:.1f} ms of processor time per frame\n",
               1e3 * ratio(summary.fine_lines, summary.frames));
  fmt::print("real-time factor   {:.4g}", ratio(summary.seconds, summary.wall));
  if (model.time_scaling != 1)
    fmt::print(" with time scaling {:g}, which is not real time; {:.4g} without", model.time_scaling,
               ratio(summary.seconds / model.time_scaling, summary.wall));
  fmt::print("\nelement updates    {:.2f} million per second\n", updates_per_second(model, summary.profile) * 1e-6);
  if (!summary.complete)
    fmt::print("the run was interrupted; these figures are those reached until then\n");
}

std::string json_of(const Model& model, const RunSummary& summary)
{
  const Monitor& monitor = summary.monitor;
  nlohmann::ordered_json json{ { "complete", summary.complete } };
  const auto add = [&json](const nlohmann::ordered_json& more) { json.update(more); };
  if (!summary.failure.empty())
    add({ { "failure", summary.failure } });
  auto landmarks = nlohmann::ordered_json::object();
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const auto [forward, left, up] = motion_of(summary, l);
    landmarks[model.landmarks[l]] = { { "forward_mm", forward }, { "left_mm", left }, { "up_mm", up } };
  }
  add({ { "backend", summary.backend },
        { "voxels", model.voxels.size() },
        { "nodes", model.nodes.size() },
        { "rigid_nodes", model.rigid.size() },
        { "sliding_nodes", model.sliding.size() },
        { "scene_hash", model.scene_hash },
        { "time_scaling", model.time_scaling },
        { "time_step_s", summary.time_step },
        { "steps", summary.profile.steps },
        { "frames", summary.frames },
        { "simulated_s", summary.seconds },
        { "landmarks", landmarks },
        { "kinetic_J", monitor.kinetic },
        { "internal_J", monitor.internal },
        { "hourglass_J", monitor.hourglass },
        { "kinetic_over_internal", ratio(monitor.kinetic, monitor.internal) },
        { "peak_kinetic_over_peak_internal", ratio(summary.peak_kinetic, summary.peak_internal) },
        { "hourglass_share", hourglass_share(monitor) } });
  if (summary.ledger)
    for (const auto& [name, joules] : energies_of(*summary.ledger))
      add({ { fmt::format("ledger_{}_J", name), joules } });
  const std::vector<BodyShape> shapes = body_shapes(model);
  for (std::size_t c = 0; c < summary.bodies.size(); ++c)
    if (!shapes[c].only_shown)
      json["reactions"][shapes[c].name] = { { "force_N", summary.bodies[c].reaction.force },
                                            { "moment_Nm", summary.bodies[c].reaction.moment } };
  if (summary.wrinkles)
    json["wrinkles"] = json_of(*summary.wrinkles);
  if (const auto& guard = summary.guard)
    add({ { "guard_checks", guard->checks }, { "guard_rollbacks", guard->rollbacks }, { "guard_s", guard->seconds } });
  if (const auto& found = summary.equilibrium)
    add({ { "equilibrium_reached", found->reached }, { "equilibrium_residual", found->residual } });
  add({ { "worst_jacobian", summary.worst_jacobian },
        { "wall_s", summary.wall },
        { "stepping_s", summary.profile.stepping },
        { "real_time_factor", ratio(summary.seconds, summary.wall) },
        { "element_updates_per_s", updates_per_second(model, summary.profile) } });
  return json_text(json);
}

}  // namespace frontalis
