#include "effect_scene.hpp"
#include "frontalis/error.hpp"
#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace frontalis
{
namespace
{

using namespace test;

Vectors motion(const Model& model, Backend backend, int threads, bool active, const char* instructions = nullptr)
{
  if (instructions != nullptr)
    ::setenv("FRONTALIS_INSTRUCTION_SET", instructions, 1);
  std::unique_ptr<Solver> solver;
  try
  {
    solver = make_solver(std::make_shared<const Model>(model), { backend, threads, 4e-6 });
  }
  catch (const Error&)
  {
    ::unsetenv("FRONTALIS_INSTRUCTION_SET");
    throw;
  }
  ::unsetenv("FRONTALIS_INSTRUCTION_SET");
  Controls controls = solver->controls();
  std::fill(controls.activation.begin(), controls.activation.end(), active ? 0.7f : 0.0f);
  solver->advance(8e-4, controls);
  Vectors u;
  solver->displacements(u);
  return u;
}

std::vector<const char*> instruction_sets()
{
  std::vector<const char*> sets;
  for (const char* set : { "baseline", "avx2", "avx512" })
    try
    {
      motion(test::scene_of(0), "cpu", 1, false, set);
      sets.push_back(set);
    }
    catch (const Error&)
    {
      // This machine does not have the instruction set.
    }
  return sets;
}

// The presence of an effect does not disable another one.
TEST(Effects, every_combination_moves_like_the_reference)
{
  std::vector<Backend> backends = available_backends();
  for (const unsigned effects : every_combination())
  {
    const Model model = test::scene_of(effects);
    const bool active = effects & test::contraction;
    const Vectors expected = motion(model, "reference", 1, active);
    for (const Backend& backend : backends)
      EXPECT_LT(difference(motion(model, backend, 1, active), expected), 2e-3) << backend << " " << effects;
  }
}

// Energies balance for every combination of effects. In models that nothing drives, all terms are rounding errors.
TEST(Effects, every_combination_balances_its_energies)
{
  for (const Backend& backend : available_backends())
    for (const unsigned effects : every_combination())
    {
      const auto solver = make_solver(std::make_shared<const Model>(scene_of(effects)), { backend, 1, 4e-6, true });
      Controls controls = solver->controls();
      std::fill(controls.activation.begin(), controls.activation.end(), effects & contraction ? 0.7f : 0.0f);
      solver->advance(8e-4, controls);
      const EnergyLedger ledger = solver->ledger();
      EXPECT_LT(std::abs(ledger.imbalance()), 4e-3 * ledger.largest + 1e-13) << backend << " " << effects;
      EXPECT_EQ(ledger.largest > 1e-9, (effects & (contraction | gravity | pressure | prescribed)) != 0) << effects;
    }
}

TEST(Effects, every_form_of_element_on_every_instruction_set_in_float_and_double)
{
  const auto sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
    for (const auto integration : { Integration::one_point, Integration::selective_reduced })
    {
      Model model = test::scene_of(test::but_friction, hourglass, integration);
      const Vectors expected = motion(model, "reference", 1, true);
      for (const auto precision : { Precision::single, Precision::compensated, Precision::double_precision })
      {
        model.precision = precision;
        for (const char* set : sets)
        {
          const Vectors one = motion(model, "cpu", 1, true, set);
          EXPECT_LT(difference(one, expected), precision == Precision::double_precision ? 1e-5 : 2e-3) << set;
          EXPECT_EQ(one, motion(model, "cpu", 3, true, set)) << set;
        }
      }
    }
}

}  // namespace
}  // namespace frontalis
