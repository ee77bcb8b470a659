// Contact with rigid bodies: blocks that are pressed, bounce, slip and slide, on every backend.

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/study/contact_model.hpp"
#include "study/verification/contact_checks.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double block_edge = 1e-3, block_young = 34e3, block_density = 1000, gravity = 9.81;

Model block(const Voxel& size, double damping, double poisson = 0.49)
{
  Model model = voxel_model(size, block_edge, neo_hookean(block_young, poisson, block_density));
  model.damping = damping;
  return model;
}

// A free block of 5 x 4 x 4 voxels above a plate.
Model falling_block(double gap, double friction)
{
  Model model = block({ { 5, 4, 4 } }, 0);
  model.contacts.push_back(touching_side(model, false, flat_body(-gap, -1)));
  model.contacts[0].friction = friction;
  return model;
}

}  // namespace

void verify_contact_pressure(const Backend&, Finding& finding)
{
  const auto verify = [&](const Backend& backend, double poisson)
  {
    Model model = block({ { 5, 4, 4 } }, 3000, poisson);
    prescribe(model, nodes_where(model, [](const auto& p) { return p[2] == 0; }), { { false, false, true } });
    model.bones = { "plate" };
    model.contacts.push_back(touching_side(model, true, flat_body(4 * block_edge, 1)));
    model.contacts[0].bone = 0;
    const auto solver = make(model, backend);
    constexpr double way = 0.206e-3;
    Controls controls = solver->controls();
    controls.bone[0].translation[2] = -way;
    for (int i = 0; i < 9; ++i)
      solver->advance(0.02, controls);
    const double pressure = solver->reactions()[0].force[2] / (20 * block_edge * block_edge);
    const Vectors u = displacements(*solver);
    double least = 1, most = 0;
    for (const auto node : nodes_where(model, [](const auto& p) { return p[2] > 3.5 * block_edge; }))
    {
      least = std::min(least, u[node][2] + way);
      most = std::max(most, u[node][2] + way);
    }
    const std::string of = ", ν = " + readable(poisson) + ", " + backend;
    finding.checks.relative("pressure over E" + of, "1", 0.05, pressure / block_young, 0.03);
    finding.checks.absolute("largest depth" + of, "% of a voxel", 0, 100 * most / block_edge, 2);
    finding.checks.absolute("unevenness of depth" + of, "%", 0, 100 * (most - least) / most, 0.5);
    finding.checks.relative("mean depth" + of, "um",
                            1e6 * pressure * block_edge / (physics::contact_stiffness * block_young),
                            1e6 * 0.5 * (most + least), 2e-3);
  };
  on_every_backend(finding,
                   [&](const Backend& backend)
                   {
                     verify(backend, 0.3);
                     verify(backend, 0.49);
                   });
}

void verify_contact_impact(const Backend&, Finding& finding)
{
  const auto verify = [&](const Backend& backend)
  {
    const Model model = falling_block(0.1e-3, 0);
    const auto solver = make(model, backend, true);
    solver->set_velocities(Vectors(model.nodes.size(), { { 0.05, 0, -0.3 } }));
    const double initial = solver->ledger().initial;
    double stored = 0, worst = 0, unexplained = 0;
    Plot plot{ "A block hits a plate, " + backend, "time [ms]", "energy over the first kinetic energy [1]" };
    plot.key = "right";
    plot.curves = { { "kinetic", {}, {}, Plot::Style::line },
                    { "of deformation", {}, {}, Plot::Style::line },
                    { "of contact", {}, {}, Plot::Style::dashed },
                    { "all", {}, {}, Plot::Style::line } };
    for (int slice = 0; slice < 60; ++slice)
    {
      solver->advance(0.1e-3, solver->controls());
      const EnergyLedger l = solver->ledger();
      const double all = l["kinetic"] + l["internal"] + l["hourglass"] + l["contact_stored"], ms = 1e3 * solver->time();
      stored = physics::larger_or_none(stored, l["contact_stored"]);
      worst = physics::larger_or_none(worst, relative(all, initial));
      unexplained = physics::larger_or_none(unexplained, 100 * std::abs(l.imbalance()) / initial);
      plot.curves[0].add(ms, l["kinetic"] / initial);
      plot.curves[1].add(ms, (l["internal"] + l["hourglass"]) / initial);
      plot.curves[2].add(ms, l["contact_stored"] / initial);
      plot.curves[3].add(ms, all / initial);
    }
    finding.checks.absolute("change of mechanical energy, " + backend, "%", 0, worst, 2);
    finding.checks.absolute("energy unexplained, " + backend, "%", 0, unexplained, 2);
    finding.checks.absolute("shortfall from 1 % stored by contact, " + backend, "%", 0,
                            physics::larger_or_none(0.0, 1 - 100 * stored / initial), 0);
    finding.checks.absolute("force after the bounce, " + backend, "N", 0, solver->reactions()[0].force[2], 0);
    finding.checks.absolute("shortfall from a rise of 0.05 mm, " + backend, "mm", 0,
                            physics::larger_or_none(0.0, 0.05 - 1e3 * mean(displacements(*solver), 2)), 0);
    if (backend == "cpu")
      finding.plots.emplace_back("contact_impact", plot);
  };
  on_every_backend(finding, verify);
}

void verify_contact_wrench(const Backend&, Finding& finding)
{
  const auto verify = [&](const Backend& backend)
  {
    const Model model = falling_block(1e-6, 0.4);
    const std::vector<double> mass = lumped_masses(model);
    constexpr double dt = 2e-6;
    const auto solver = make(model, backend, false, dt);
    // The block arrives obliquely and rotates, so that no component of momentum is zero.
    Vectors velocity;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
      const Point p = rest_position(model, n);
      velocity.push_back({ { 0.1 + 10 * p[1], -0.05, -0.3 - 20 * p[0] } });
    }
    solver->set_velocities(velocity);
    Wrench gained{}, lost{};
    Vectors before = displacements(*solver);
    for (int step = 0; step < 600; ++step)
    {
      solver->advance(dt, solver->controls());
      const Reaction reaction = solver->reactions()[0];
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        gained[axis] += dt * reaction.force[axis];
        gained[3 + axis] += dt * reaction.moment[axis];
      }
      const Vectors after = displacements(*solver);
      for (std::size_t n = 0; n < mass.size(); ++n)
      {
        Point place = rest_position(model, n), change{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          const double now = (after[n][axis] - before[n][axis]) / dt;
          change[axis] = mass[n] * (velocity[n][axis] - now);
          place[axis] += before[n][axis];
          velocity[n][axis] = now;
        }
        add_momentum(lost, place, change);
      }
      before = after;
    }
    for (std::size_t i = 0; i < 6; ++i)
    {
      const std::string what = i < 3 ? "impulse " : "angular impulse ", axis(1, "xyz"[i % 3]);
      finding.checks.relative(what + axis + ", " + backend, i < 3 ? "uN s" : "nN m s", (i < 3 ? 1e6 : 1e9) * lost[i],
                              (i < 3 ? 1e6 : 1e9) * gained[i], 1e-4);
    }
  };
  on_every_backend(finding, verify);
}

void verify_contact_incline(const Backend&, Finding& finding)
{
  // The angle of friction is 26.6 degrees. Gravity starts suddenly, and the block bounces until it has settled.
  constexpr double friction = 0.5, damping = 50, settling = 0.15, time = 0.05, degree = 3.14159265358979 / 180;
  const auto on_incline = [&](double degrees, const Backend& backend)
  {
    Model model = block({ { 6, 4, 2 } }, damping);
    model.contacts.push_back(touching_side(model, false, flat_body(0, -1)));
    model.contacts[0].friction = friction;
    model.gravity = { { gravity * std::sin(degrees * degree), 0, -gravity * std::cos(degrees * degree) } };
    auto solver = make(model, backend);
    solver->advance(settling, {});
    return solver;
  };
  const auto way = [&](Solver& solver)
  {
    const double begin = mean(displacements(solver), 0);
    solver.advance(time, {});
    return mean(displacements(solver), 0) - begin;
  };
  const auto verify = [&](const Backend& backend)
  {
    finding.checks.absolute("way at 22°, " + backend, "um", 0, 1e6 * way(*on_incline(22, backend)), 1e-3);
    for (const double degrees : { 35.0, 60.0 })
    {
      // With damping c and acceleration a, a block that moves by w in a time t moves by q w + a t (1 - q) / c in the
      // next interval of this length, where q = exp(-c t).
      const auto solver = on_incline(degrees, backend);
      const double first = way(*solver), second = way(*solver), q = std::exp(-damping * time);
      finding.checks.relative("acceleration at " + readable(degrees) + "°, " + backend, "m/s2",
                              gravity * (std::sin(degrees * degree) - friction * std::cos(degrees * degree)),
                              damping * (second - q * first) / (time * (1 - q)), 6e-3);
    }
  };
  on_every_backend(finding, verify);
}

}  // namespace frontalis
