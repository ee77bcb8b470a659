// When tissue that touches itself is searched for pairs, and that none is missed.

#include "tissue_contact_model.hpp"

#include "solver/contact/tissue_contact.hpp"
#include "solver/stepping/discretisation.hpp"

#include <gtest/gtest.h>

#include <random>

namespace frontalis
{
namespace
{

using namespace test;

using Point = std::array<double, 3>;
using Field = std::array<std::vector<double>, 3>;

constexpr double edge = 1e-3;

// Two balls of voxels with smooth surfaces, whose centres are 13 mm apart.
Model two_balls()
{
  const double radius = 5.2, middle = 6.5;
  BlockSettings settings;
  settings.voxels = { { 26, 13, 13 } };
  settings.keep = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  { return std::hypot((i < 13 ? i : i - 13) + 0.5 - middle, j + 0.5 - middle, k + 0.5 - middle) < radius; };
  Model model = block_model(settings);
  SelfContact contact;
  for (const double x : { middle, middle + 13 })
    add_sphere(model, contact, { { edge * x, edge * middle, edge * middle } }, edge * radius);
  model.self_contacts.push_back(contact);
  return model;
}

// Contact of a model whose nodes go where the test moves them.
class Moved
{
public:
  explicit Moved(const Model& model)
      : model_(model), discretisation_(model), contact_(model, discretisation_, plain_touch_kernels<double>())
  {
    for (auto& u : now_)
      u.assign(model.nodes.size(), 0);
  }

  template <class Place>
  void step(const Place& place)
  {
    const Field before = now_;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
    {
      Point rest{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        rest[axis] = model_.spacing[axis] * model_.nodes[n][axis];
      const Point u = place(rest);
      for (std::size_t axis = 0; axis < 3; ++axis)
        now_[axis][n] = u[axis];
    }
    contact_.after_step(share(), pointers(before).data(), pointers(now_).data());
  }
  // The forces on the nodes at the present displacements.
  Field forces()
  {
    Field internal;
    for (auto& f : internal)
      f.assign(model_.nodes.size(), 0);
    ConstraintStep step;
    step.dt = 1e-5;
    contact_.prepare_step(share(), pointers(now_).data());
    contact_.before_step(share(), pointers(now_).data(), step);
    double* const to[3] = { internal[0].data(), internal[1].data(), internal[2].data() };
    contact_.add_forces(share(), ForceSink<double>(to));
    return internal;
  }
  // The same forces, after a search from the beginning.
  Field forces_of_a_new_search(const Field& u)
  {
    contact_.reset();
    now_ = u;
    Field found;
    for (int step = 0; step < 3; ++step)
    {
      contact_.after_step(share(), pointers(now_).data(), pointers(now_).data());
      found = forces();
    }
    return found;
  }
  const Field& now() const { return now_; }
  std::int64_t searches() const { return contact_.searches(); }

private:
  static std::array<const double*, 3> pointers(const Field& u) { return { { u[0].data(), u[1].data(), u[2].data() } }; }
  NodeShare share() const { return { 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) }; }

  const Model& model_;
  Discretisation discretisation_;
  TissueContact<double> contact_;
  Field now_;
};

double length_of(const Field& forces)
{
  double sum = 0;
  for (const auto& f : forces)
    for (const double component : f)
      sum += component * component;
  return std::sqrt(sum);
}

// One ball swings past the other, which turns, by up to a tenth of a voxel per step, with jolts; they touch and part
// again and again.
TEST(TissueContactSearch, misses_no_pair_in_fast_motion)
{
  const Model model = two_balls();
  Moved moved(model), fresh(model);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jolt(-0.03 * edge, 0.03 * edge);
  int touching = 0;
  double largest = 0;
  for (int n = 0; n < 900; ++n)
  {
    const double swing = 0.012 * n, turn = 0.008 * n;
    const Point shift{ { -edge * (2.55 + 0.35 * std::sin(3.1 * swing)) + jolt(random),
                         2.2 * edge * std::sin(swing) + jolt(random),
                         1.6 * edge * std::sin(1.7 * swing) + jolt(random) } };
    moved.step(
        [&](const Point& p)
        {
          if (p[0] > 13.5 * edge)
            return shift;
          const double x = p[0] - 6.5 * edge, y = p[1] - 6.5 * edge;
          return Point{ { (std::cos(turn) - 1) * x - std::sin(turn) * y, std::sin(turn) * x + (std::cos(turn) - 1) * y,
                          0 } };
        });
    const Field found = moved.forces();
    if (n < 3 || n % 3 != 0)
      continue;
    const Field expected = fresh.forces_of_a_new_search(moved.now());
    double difference = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t node = 0; node < found[axis].size(); ++node)
        difference += std::pow(found[axis][node] - expected[axis][node], 2);
    const double force = length_of(expected);
    largest = std::max(largest, force);
    touching += force > 0 ? 1 : 0;
    EXPECT_LE(std::sqrt(difference), 0.01 * force + 1e-3 * largest) << n;
  }
  EXPECT_GT(touching, 60);
  EXPECT_LT(touching, 250);
  EXPECT_GT(moved.searches(), 5);
  EXPECT_LT(moved.searches(), 200);
}

// Nothing that is close to something else approaches it, however far all of it moves.
TEST(TissueContactSearch, is_not_repeated_while_nothing_approaches)
{
  const Model model = two_balls();
  const auto close = [](const Point& p) { return Point{ { p[0] > 13.5 * edge ? -2.3 * edge : 0, 0, 0 } }; };
  Moved shifted(model), stretched(model), apart(model), nearer(model);
  for (int n = 0; n < 400; ++n)
  {
    const double way = 0.03 * edge * n;
    shifted.step(
        [&](const Point& p)
        {
          const Point at = close(p);
          return Point{ { at[0] + way, -way, 2 * way } };
        });
    // The ends get farther from each other by 3 mm.
    stretched.step(
        [&](const Point& p)
        {
          const Point at = close(p);
          return Point{ { at[0] + 0.01 * way * (p[0] / edge - 13), at[1] + 0.01 * way * p[1] / edge, at[2] } };
        });
    apart.step([&](const Point& p) { return Point{ { (p[0] > 13.5 * edge ? way : 0), 0, 0 } }; });
    nearer.step([&](const Point& p) { return Point{ { (p[0] > 13.5 * edge ? -0.25 * way : 0), 0, 0 } }; });
    for (Moved* const each : { &shifted, &stretched, &apart, &nearer })
      each->forces();
  }
  EXPECT_EQ(shifted.searches(), 1);
  EXPECT_EQ(stretched.searches(), 1);
  EXPECT_EQ(apart.searches(), 1);
  EXPECT_GE(nearer.searches(), 2);  // one ball moves by 3 mm towards the other, which is 2.6 mm away
}

}  // namespace
}  // namespace frontalis
