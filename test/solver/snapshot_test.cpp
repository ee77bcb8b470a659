#include "backends.hpp"
#include "effect_scene.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

/// The observable results of a motion.
struct Seen
{
  Vectors u;
  std::vector<float> activation;
  double time, time_step, work;

  bool operator==(const Seen& other) const
  {
    return u == other.u && activation == other.activation && time == other.time && time_step == other.time_step &&
           work == other.work;
  }
};

struct Variant
{
  std::string name;
  std::function<void(Model&)> change;
  bool ledger = false;
  int parts = 1;  // number of parts of a run; each part has 80 steps
};

// Lets the floor move with a bone, and gives it friction.
void move_floor(Model& m)
{
  m.bones = { "jaw" };
  m.constraint_surfaces[0].bone = 0;
  m.constraint_surfaces[0].friction = 0.4;
}

// The nodes on the floor follow those above them along the floor's normal. Voxels are cut.
void attach_to_floor(Model& m)
{
  for (const SlidingNode& node : m.sliding)
  {
    auto above = m.nodes[node.node];
    ++above[2];
    const auto master = std::find(m.nodes.begin(), m.nodes.end(), above) - m.nodes.begin();
    m.attached.push_back({ node.node, static_cast<std::int32_t>(master), 0.3, -1, node.surface, -1 });
  }
  m.sliding.clear();
  m.tissue_centre.assign(m.voxels.size(), { { 0.2F, -0.1F, 0.5F } });
}

// Makes the load constant, so that on a GPU one launch makes all steps of a plan.
void steady(Model& m)
{
  for (Load& load : m.loads)
    if (load.kind == Load::Kind::pressure)
      load.kind = Load::Kind::traction;
}

// Steps are to be longer than the model allows at rest.
void add_mass_in_motion(Model& m)
{
  m.time_step_estimate = TimeStepEstimate::assembled;
  m.mass_scaling.kind = MassScalingSettings::Kind::uniform;
  m.mass_scaling.in_motion = 6e-5;
}

// Models with all effects at once: with a moving floor and friction, with each precision, with the assembled time step.
std::vector<Variant> variants()
{
  return { { "plain", [](Model&) {} },
           { "ledger", [](Model&) {}, true },
           { "assembled", [](Model& m) { m.time_step_estimate = TimeStepEstimate::assembled; }, false, 4 },
           { "mass in motion", add_mass_in_motion, true, 4 },
           { "mass in motion, attached",
             [](Model& m)
             {
               add_mass_in_motion(m);
               attach_to_floor(m);
             },
             false, 4 },
           { "compensated", [](Model& m) { m.precision = Precision::compensated; } },
           { "double", [](Model& m) { m.precision = Precision::double_precision; } },
           { "reduced", [](Model& m) { m.integration = Integration::selective_reduced; } },
           { "moved", move_floor, true },
           { "attached", attach_to_floor, true },
           { "attached, moved",
             [](Model& m)
             {
               move_floor(m);
               attach_to_floor(m);
             } },
           { "steady", steady },
           { "moved, steady",
             [](Model& m)
             {
               move_floor(m);
               steady(m);
             } },
           { "slow muscle", [](Model& m) { m.muscles[0].rise_time = 5e-4; } } };
}

class Snapshots : public test::EveryBackend
{
protected:
  std::unique_ptr<Solver> solver_of(const Variant& variant) const
  {
    Model model = test::scene_of(test::but_friction);
    variant.change(model);
    return make_solver(std::make_shared<const Model>(model), { GetParam(), 2, 0, variant.ledger });
  }
  static Seen play(Solver& solver, const Variant& variant, float activation, double along)
  {
    Controls controls = solver.controls();
    std::fill(controls.activation.begin(), controls.activation.end(), activation);
    for (auto& bone : controls.bone)
      bone = rigid_motion({ { 0, 0, 0 } }, { { along, 0, 2e-5 } });
    for (int part = 0; part < variant.parts; ++part)
      solver.advance(1.6e-3, controls);
    Seen seen{ {}, solver.activation(), solver.time(), solver.time_step(), 0 };
    solver.displacements(seen.u);
    if (variant.ledger)
    {
      const EnergyLedger l = solver.ledger();
      seen.work =
          l["muscle"] + 3 * l["constraint"] + 5 * l["viscous"] + 7 * l["damping"] + 11 * l["friction"] + 13 * l["load"];
    }
    return seen;
  }
};

TEST_P(Snapshots, motion_goes_on_with_the_same_bits)
{
  for (const Variant& variant : variants())
  {
    const auto solver = solver_of(variant);
    play(*solver, variant, 0.7f, 1e-4);
    std::unique_ptr<Snapshot> snapshot;
    solver->save(snapshot);
    const Seen first = play(*solver, variant, 0.2f, 3e-4);
    solver->restore(*snapshot);
    const Seen second = play(*solver, variant, 0.2f, 3e-4);
    EXPECT_TRUE(first == second) << variant.name;
    // The restored state must not depend on the motion before restore().
    solver->set_displacements(Vectors(first.u.size(), { { 1e-5, 0, 0 } }));
    play(*solver, variant, 1, 0);
    solver->reset();
    solver->restore(*snapshot);
    EXPECT_TRUE(play(*solver, variant, 0.2f, 3e-4) == first) << variant.name;
    // Taking a snapshot does not change the motion, and reusing its memory does not change the next snapshot.
    const auto plain = solver_of(variant);
    play(*plain, variant, 0.7f, 1e-4);
    EXPECT_TRUE(play(*plain, variant, 0.2f, 3e-4) == first) << variant.name;
    solver->save(snapshot);
    const Seen third = play(*solver, variant, 0.5f, 0);
    EXPECT_FALSE(third == first);
    solver->restore(*snapshot);
    EXPECT_TRUE(play(*solver, variant, 0.5f, 0) == third) << variant.name;
  }
}

TEST_P(Snapshots, a_reset_leaves_nothing_behind)
{
  for (const Variant& variant : variants())
  {
    const auto fresh = solver_of(variant), used = solver_of(variant);
    play(*used, variant, 0.7f, 3e-4);
    used->slow_down(0.5);
    play(*used, variant, 0.2f, 1e-4);
    used->slow_down(1);
    used->reset();
    EXPECT_EQ(used->monitor().step_share, 0) << variant.name;
    EXPECT_TRUE(play(*used, variant, 0.7f, 1e-4) == play(*fresh, variant, 0.7f, 1e-4)) << variant.name;
  }
}

// The assembled estimate lengthens steps, and mass is added, during the motions of the variants that are about them.
TEST_P(Snapshots, the_assembled_time_step_and_mass_come_within_a_play)
{
  const auto one = solver_of(variants()[0]), other = solver_of(variants()[2]);
  EXPECT_GT(play(*other, variants()[2], 0.7f, 0).time_step, 1.01 * play(*one, variants()[2], 0.7f, 0).time_step);
  const auto heavy = solver_of(variants()[3]);
  play(*heavy, variants()[3], 0.7f, 0);
  EXPECT_GT(heavy->monitor().added_mass, 0);
}

TEST_P(Snapshots, go_on_in_another_solver_as_bytes)
{
  for (const Variant& variant : variants())
  {
    const auto solver = solver_of(variant);
    play(*solver, variant, 0.7f, 1e-4);
    const std::string bytes = solver->pack();
    const Seen here = play(*solver, variant, 0.2f, 3e-4);
    const auto other = solver_of(variant);
    other->unpack(bytes);
    EXPECT_TRUE(play(*other, variant, 0.2f, 3e-4) == here) << variant.name;
    // Damaged bytes are refused, and nothing changes.
    const Seen before = play(*other, variant, 0.2f, 3e-4);
    other->unpack(bytes);
    play(*other, variant, 0.2f, 3e-4);
    for (const std::string& bad : { std::string(), bytes.substr(0, bytes.size() / 2), "x" + bytes, bytes + "x" })
      EXPECT_THROW(other->unpack(bad), Error);
    EXPECT_TRUE(play(*other, variant, 0.2f, 3e-4) == before) << variant.name;
  }
  Model larger = test::scene_of(0);
  const auto stranger = make_solver(std::make_shared<const Model>(larger), { GetParam(), 2 });
  EXPECT_THROW(stranger->unpack(solver_of(variants()[1])->pack()), Error);
}

TEST_P(Snapshots, belong_to_their_solver)
{
  const auto one = solver_of(variants()[0]), other = solver_of(variants()[0]);
  std::unique_ptr<Snapshot> snapshot;
  one->save(snapshot);
  EXPECT_THROW(other->restore(*snapshot), Error);
}

TEST_P(Snapshots, lead_back_from_a_motion_that_diverged)
{
  const auto solver = solver_of(variants()[0]);
  play(*solver, variants()[0], 0.7f, 0);
  std::unique_ptr<Snapshot> snapshot;
  solver->save(snapshot);
  const Seen first = play(*solver, variants()[0], 0.2f, 0);
  solver->set_displacements(Vectors(first.u.size(), { { std::nan(""), 0, 0 } }));
  EXPECT_THROW(play(*solver, variants()[0], 0.2f, 0), Diverged);
  EXPECT_THROW(play(*solver, variants()[0], 0.2f, 0), Error);
  solver->restore(*snapshot);
  EXPECT_TRUE(play(*solver, variants()[0], 0.2f, 0) == first);
}

TEST_P(Snapshots, the_time_step_can_be_taken_shorter)
{
  const auto solver = solver_of(variants()[0]);
  const double full = solver->time_step();
  solver->slow_down(0.25);
  EXPECT_DOUBLE_EQ(solver->time_step(), 0.25 * full);
  for (const double bad : { 0.0, -1.0, 1.5, std::nan("") })
    EXPECT_THROW(solver->slow_down(bad), Error);
  solver->slow_down(1);
  EXPECT_EQ(solver->time_step(), full);
}

FRONTALIS_EVERY_BACKEND(Snapshots);

}  // namespace
}  // namespace frontalis
