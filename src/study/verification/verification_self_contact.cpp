// Contact of tissue with itself: blocks that are pressed together at several placements in the grid, and that collide.

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/study/cut_voxels_model.hpp"
#include "frontalis/study/self_contact_model.hpp"
#include "study/verification/contact_checks.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double bodies_edge = 1e-3, bodies_young = 34e3, bodies_density = 1000, bodies_degree = 3.14159265358979 / 180;

// Lengths in voxels: sides and height of a block, and the gap between the two blocks.
constexpr double bodies_length = 18, bodies_width = 4, bodies_height = 6, bodies_gap = 3;

// Two blocks, one above the other, in a grid that is turned about y and shifted along x and z. With `cut`, partly
// filled voxels have their stress at the tissue's centroid. Without it, they have their stress at the voxel's centre,
// and voxels of which less than a fifth is filled are left out.
class Blocks
{
public:
  Blocks(double degrees, double shift, double poisson, bool cut)
      : cosine_(std::cos(degrees * bodies_degree)),
        sine_(std::sin(degrees * bodies_degree)),
        shift_(shift * bodies_edge)
  {
    const double top = 2 * bodies_height + bodies_gap;
    const auto voxels = [&](double way) { return static_cast<std::int32_t>(std::ceil(way + shift - 1e-9)); };
    VoxelBox box{ { { voxels(cosine_ * bodies_length + sine_ * top), static_cast<std::int32_t>(bodies_width),
                      voxels(sine_ * bodies_length + cosine_ * top) } },
                  { { bodies_edge, bodies_edge, bodies_edge } },
                  { neo_hookean(bodies_young, poisson, bodies_density) } };
    const auto inside = [&](const Point& p)
    {
      const Point q = in_blocks(p);
      return q[0] > 0 && q[0] < bodies_length && q[2] > 0 && q[2] < top &&
             (q[2] < bodies_height || q[2] > bodies_height + bodies_gap);
    };
    constexpr int samples = 16;  // number of samples along each edge of a voxel
    box.fill = cut ? sampled_fill(box.spacing, inside, samples, 0.02) : sampled_fill(box.spacing, inside);
    model = voxel_model(box);
    if (cut)
      cut_at_surface(model, inside, samples);
    for (const bool upper : { false, true })
    {
      // The outer side of each block slides on a plane; the upper plane moves with a bone.
      const double end = upper ? top : 0, normal = 1000;
      const Point centre = in_grid({ { 0.5 * bodies_length, 0.5 * bodies_width, end + normal / bodies_edge } });
      const auto surface =
          slide_on(model, upper ? "upper" : "lower", sphere_field(centre, normal),
                   nodes_where(model, [&](const Point& p) { return std::abs(in_blocks(p)[2] - end) < 0.5; }));
      model.constraint_surfaces[surface].bone = upper ? 0 : -1;
    }
    model.bones = { "upper" };
    const auto side = [&](double z, bool faces_up)
    {
      return grid_mesh(static_cast<int>(2 * bodies_length), static_cast<int>(2 * bodies_width),
                       [&](double s, double t) {
                         return in_grid({ { bodies_length * (faces_up ? s : 1 - s), bodies_width * t, z } });
                       });
    };
    let_touch(model, { side(bodies_height, true), side(bodies_height + bodies_gap, false) }, 0);
  }

  /// Transforms coordinates of the blocks [voxels] to coordinates of the grid [m], and back.
  Point in_grid(const Point& q) const
  {
    const double x = bodies_edge * q[0], z = bodies_edge * q[2];
    return { { cosine_ * x + sine_ * z + shift_, bodies_edge * q[1],
               sine_ * (bodies_edge * bodies_length - x) + cosine_ * z + shift_ } };
  }
  Point in_blocks(const Point& p) const
  {
    const double x = p[0] - shift_, z = p[2] - shift_ - sine_ * bodies_edge * bodies_length;
    return { { (cosine_ * x - sine_ * z) / bodies_edge, p[1] / bodies_edge, (sine_ * x + cosine_ * z) / bodies_edge } };
  }
  /// Component [m] of a vector normal to the surfaces.
  double across(const Point& v) const { return sine_ * v[0] + cosine_ * v[2]; }

  Model model;

private:
  double cosine_, sine_, shift_;
};

// Displacement of a point along the normal of the surfaces [m].
double across_at(const Blocks& blocks, const Vectors& u, const Point& q)
{
  const Binding there = bind_points(blocks.model, { blocks.in_grid(q) });
  const auto& at = there.coordinates[0];
  double sum = 0;
  for (std::size_t b = 0; b < 8; ++b)
  {
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      weight *= (b >> axis & 1) != 0 ? double(at[axis]) : 1 - double(at[axis]);
    sum += weight * blocks.across(u[blocks.model.voxel_nodes[there.voxel[0]][b]]);
  }
  return sum;
}

void press(const std::string& place, double degrees, double shift, double poisson, bool cut, const Backend& backend,
           Finding& finding)
{
  Blocks blocks(degrees, shift, poisson, cut);
  blocks.model.damping = 3000;
  const auto solver = make(blocks.model, backend);
  constexpr double strain = 0.052, way = (bodies_gap + 2 * bodies_height * strain) * bodies_edge;
  Controls controls = solver->controls();
  controls.bone[0].translation = { { -way * blocks.across({ { 1, 0, 0 } }), 0,
                                     -way * blocks.across({ { 0, 0, 1 } }) } };
  solver->advance(0.03, controls);
  solver->advance(0.06, controls);
  const Vectors u = displacements(*solver);
  // The surroundings of the free sides, which are staircases, are left out.
  constexpr double margin = bodies_height;
  double least = 1, most = 0, sum = 0, squeezed = 0;
  int count = 0;
  for (double x = margin; x <= bodies_length - margin; x += 0.5)
    for (double y = 0.5; y <= bodies_width - 0.5; y += 0.5)
    {
      const double lower = across_at(blocks, u, { { x, y, bodies_height } });
      const double upper = across_at(blocks, u, { { x, y, bodies_height + bodies_gap } });
      const double overlap = lower - upper - bodies_gap * bodies_edge;
      least = std::min(least, overlap);
      most = std::max(most, overlap);
      sum += overlap;
      squeezed += across_at(blocks, u, { { x, y, 1.5 } }) - across_at(blocks, u, { { x, y, bodies_height - 1.5 } });
      ++count;
    }
  // Neo-Hookean tissue stiffens under compression: pressure / E = strain (1 + strain), to second order.
  const double found = squeezed / (count * (bodies_height - 3) * bodies_edge), pressure = found * (1 + found);
  const std::string of = ", " + place + ", ν = " + readable(poisson) + ", " + backend;
  finding.checks.relative("pressure over E" + of, "1", 0.05, pressure, 0.1);
  finding.checks.absolute("largest overlap" + of, "% of a voxel", 0, 100 * most / bodies_edge, 2);
  const double uneven = 100 * (most - least) * count / sum;
  if (degrees == 0 || (cut && shift == 0))
    finding.checks.absolute("unevenness of overlap" + of, "%", 0, uneven, 5);
  else
    finding.checks.absolute("unevenness of overlap" + of, "%", 0, uneven, std::nan(""));
  finding.checks.relative("mean overlap" + of, "um", 1e6 * pressure * bodies_edge / physics::contact_stiffness,
                          1e6 * sum / count, 0.03);
}

// The upper block flies obliquely towards the lower one and rotates, without damping.
void collide(const Backend& backend, Finding& finding)
{
  Blocks blocks(0, 0, 0.45, false);
  Model& model = blocks.model;
  model.sliding.clear();
  model.constraint_surfaces.clear();
  model.bones.clear();
  const std::vector<double> mass = lumped_masses(model);
  const auto solver = make(model, backend, true);
  Vectors u(model.nodes.size()), velocity(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    if (const Point p = rest_position(model, n); p[2] > (bodies_height + 0.5 * bodies_gap) * bodies_edge)
    {
      u[n][2] = (0.05 - bodies_gap) * bodies_edge;
      velocity[n] = { { 0.1 + 10 * p[1], -0.05, -0.3 - 10 * p[0] } };
    }
  solver->set_displacements(u);
  solver->set_velocities(velocity);
  const auto momenta = [&]
  {
    // The velocities are taken from one step, in which positions move along the velocity; this adds no angular
    // momentum.
    const Vectors from = displacements(*solver);
    const double begin = solver->time();
    solver->advance(0.5 * solver->time_step(), solver->controls());
    const Vectors to = displacements(*solver);
    Wrench sum{};
    for (std::size_t n = 0; n < from.size(); ++n)
    {
      Point place = rest_position(model, n), momentum{};
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        place[axis] += from[n][axis];
        momentum[axis] = mass[n] * (to[n][axis] - from[n][axis]) / (solver->time() - begin);
      }
      add_momentum(sum, place, momentum);
    }
    return sum;
  };
  const Wrench before = momenta();
  const double initial = solver->ledger().initial;
  double stored = 0, worst = 0;
  for (int slice = 0; slice < 80; ++slice)
  {
    solver->advance(0.1e-3, solver->controls());
    const EnergyLedger l = solver->ledger();
    stored = physics::larger_or_none(stored, l["contact_stored"]);
    worst = physics::larger_or_none(
        worst, relative(l["kinetic"] + l["internal"] + l["hourglass"] + l["contact_stored"], initial));
  }
  finding.checks.absolute("stored when parted, " + backend, "%", 0, 100 * solver->ledger()["contact_stored"] / initial,
                          0);
  finding.checks.absolute("shortfall from 0.5 % stored by contact, " + backend, "%", 0,
                          physics::larger_or_none(0.0, 0.5 - 100 * stored / initial), 0);
  finding.checks.absolute("change of mechanical energy, " + backend, "%", 0, worst, 1);
  const Wrench after = momenta();
  double change[2] = { 0, 0 };
  for (std::size_t i = 0; i < 6; ++i)
    change[i / 3] =
        physics::larger_or_none(change[i / 3], std::abs(after[i] - before[i]) / std::abs(before[i < 3 ? 2 : 4]));
  finding.checks.absolute("change of momentum, " + backend, "1e-6", 0, 1e6 * change[0], 10);
  finding.checks.absolute("change of angular momentum, " + backend, "1e-6", 0, 1e6 * change[1], 10);
}

}  // namespace

void verify_self_contact(const Backend&, Finding& finding)
{
  on_every_backend(finding,
                   [&](const Backend& backend)
                   {
                     for (const double poisson : { 0.3, 0.49 })
                     {
                       press("along the grid", 0, 0, poisson, false, backend, finding);
                       if (backend == "reference")  // the reference backend is slow
                         continue;
                       press("shifted by 1/3", 0, 1.0 / 3, poisson, false, backend, finding);
                       press("turned by 20°", 20, 0, poisson, false, backend, finding);
                       unless_unavailable(finding,
                                          [&]
                                          {
                                            press("turned by 20°, cut voxels", 20, 0, poisson, true, backend, finding);
                                            press("turned and shifted, cut voxels", 20, 1.0 / 3, poisson, true, backend,
                                                  finding);
                                          });
                     }
                     collide(backend, finding);
                   });
}

}  // namespace frontalis
