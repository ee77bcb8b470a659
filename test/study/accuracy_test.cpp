#include "files.hpp"
#include "frontalis/error.hpp"
#include "frontalis/study/accuracy.hpp"
#include "frontalis/study/voxel_model.hpp"
#include "study/accuracy/accuracy_bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

namespace frontalis
{
namespace
{

constexpr double length = 8e-3, width = 4e-3;

// A bar of tissue that is held at x = 0. A muscle in its upper half shortens the bar and bends it up.
Model bar(const AccuracySetting& setting)
{
  const double edge = setting.profile.voxel[0];
  const auto n = static_cast<std::int32_t>(std::lround(length / edge)),
             m = static_cast<std::int32_t>(std::lround(width / edge));
  VoxelBox box;
  box.size = { { n, m, m } };
  box.spacing.fill(edge);
  box.materials = { neo_hookean(30e3, 0.45) };
  Model model = voxel_model(box);
  Muscle muscle;
  muscle.name = "pull";
  muscle.stress_reference = 20e3;
  muscle.tension_length = false;
  add_muscle(model, muscle, [](std::size_t) { return std::array<float, 3>{ { 1, 0, 0 } }; });
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.fibre_weight[e] = m == 1 ? 0.5F : 2 * model.voxels[e][2] >= m ? 1 : 0;
  for (const std::int32_t node : nodes_where(model, [](const auto& p) { return p[0] == 0; }))
    model.rigid.push_back({ node, -1 });
  // The skin is the upper face. Its points are corners of voxels of every size.
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 1; ++j)
    {
      const std::int32_t x = std::max(i * n / 2 - 1, 0), y = j * m - j;
      const std::size_t voxel = static_cast<std::size_t>(((m - 1) * m + y) * n + x);
      model.skin.vertices.push_back({ { i * 0.5 * length, j * width, width } });
      model.skin_binding.voxel.push_back(static_cast<std::int32_t>(voxel));
      model.skin_binding.coordinates.push_back({ { i > 0 ? 1.F : 0.F, static_cast<float>(j), 1 } });
    }
  model.skin.triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 2, 4, 3 }, { 3, 4, 5 } };
  model.damping = 60;
  model.time_step_share = setting.profile.time_step_share;
  model.time_scaling = setting.time_scaling;
  model.hourglass = setting.profile.assumed_strain ? HourglassControl::assumed_strain : HourglassControl::scalar;
  if (setting.profile.precision == "double")
    model.precision = Precision::double_precision;
  // Any other number of samples makes the bake fail.
  if (setting.profile.samples != 4)
    throw Error("no such bar");
  return model;
}

class Accuracy : public testing::Test
{
protected:
  void SetUp() override
  {
    plan.folder = folder.path();
    plan.standard.profile.voxel.fill(2e-3);
    plan.edges = { 4e-3, 2e-3, 1e-3, 0.5e-3 };
    plan.knobs = { "voxel", "hourglass" };
    plan.history = { { 0.5F }, {}, 0.1, 0.1 };
    plan.quick = true;
    plan.threads = 1;
    maker.content = [](const AccuracySetting& s)
    {
      std::string text;
      for (const double value :
           { s.profile.voxel[0], s.profile.time_step_share, s.profile.bulk_modulus_max, s.time_scaling,
             static_cast<double>(s.profile.samples), s.profile.assumed_strain ? 1.0 : 0.0 })
        text += std::to_string(1e6 * value) + " ";
      return text + s.profile.precision;
    };
    maker.bake = bar;
  }

  AccuracyFindings study()
  {
    return study_accuracy(plan, maker,
                          [this](const std::string&, double done, double)
                          {
                            moved += done > 0 ? 1 : 0;
                            return moved < interrupt_after;
                          });
  }
  std::string fault()
  {
    try
    {
      study();
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder;
  AccuracyPlan plan;
  ModelMaker maker;
  int moved = 0, interrupt_after = 1 << 30;
};

const AccuracyRow& row_named(const AccuracyFindings& findings, const std::string& name)
{
  for (const AccuracyRow& row : findings.rows)
    if (row.name == name)
      return row;
  throw Error("no row is called " + name);
}

// Error of the settled skin, by comparison with a bar whose voxel edge is half that of the reference.
double true_error(const AccuracySetting& setting)
{
  AccuracySetting finer = setting;
  finer.profile.voxel.fill(0.25e-3);
  finer.profile.assumed_strain = true;
  SkinState skins[2];
  for (const int which : { 0, 1 })
  {
    const auto solver = make_solver(std::make_shared<const Model>(bar(which == 0 ? setting : finer)), { "cpu", 1 });
    solver->settle({ { 0.5F }, {} }, 1e-3, 0.4);
    solver->skin(skins[which]);
  }
  // Area of each vertex in units of a third of a triangle, which is the number of triangles at the vertex.
  const double area[] = { 1, 2, 3, 3, 2, 1 };
  double sum = 0;
  for (std::size_t v = 0; v < 6; ++v)
    for (int axis = 0; axis < 3; ++axis)
      sum += area[v] / 12 * std::pow(skins[0].vertices[v][axis] - skins[1].vertices[v][axis], 2);
  return std::sqrt(sum);
}

// Steps per simulated second of the motion in the study.
double true_steps(const AccuracySetting& setting)
{
  const auto solver = make_solver(std::make_shared<const Model>(bar(setting)), { "cpu", 1 });
  solver->advance(0.1, { { 0.5F }, {} });
  solver->advance(0.1, { { 0.5F }, {} });
  return static_cast<double>(solver->profile().steps) / 0.2;
}

TEST_F(Accuracy, what_is_chosen_keeps_its_promise)
{
  const AccuracyFindings findings = study();
  ASSERT_TRUE(findings.complete);
  const double coarse = row_named(findings, "4 mm").error.rms, standard = row_named(findings, "standard").error.rms,
               fine = row_named(findings, "1 mm").error.rms;
  EXPECT_GT(coarse, 1.5 * standard);
  EXPECT_GT(standard, 1.5 * fine);
  EXPECT_GT(findings.reference_error, 0);
  EXPECT_LT(findings.reference_error, standard);
  EXPECT_GT(findings.motion, 5 * standard) << "errors are small beside the motion";
  EXPECT_GT(row_named(findings, "standard").averaged, 0);
  EXPECT_LT(row_named(findings, "standard").averaged, standard) << "what neighbours err by against each other is gone";

  const double tolerance = 1.02 * standard;
  const AccuracyRow& chosen = cheapest_within(findings, tolerance);
  EXPECT_LE(chosen.error.rms, tolerance);
  EXPECT_LT(true_error(chosen.setting), 1.2 * tolerance);
  EXPECT_NEAR(true_error(chosen.setting) / chosen.settled.rms, 1, 0.2);
  const AccuracyRow& best = most_accurate_within(findings, 1e9);
  // A costlier setting is in the front if its error is 5 % smaller. Errors below that of the reference count as equal.
  EXPECT_LE(0.95 * best.error.rms, std::max(fine, findings.reference_error));
  EXPECT_TRUE(best.error.rms <= fine || best.cost <= row_named(findings, "1 mm").cost)
      << "a setting with a larger error must be cheaper";
  EXPECT_NEAR(true_error(best.setting) / best.settled.rms, 1, 0.2 + findings.reference_error / best.settled.rms);
  // Costs in seconds depend on the machine, but the number of steps does not.
  const AccuracyRow& quick = most_accurate_within(findings, findings.rows[findings.front.front()].cost);
  EXPECT_EQ(quick.name, findings.rows[findings.front.front()].name);
  for (const AccuracyRow* row : { &chosen, &best, &quick })
  {
    EXPECT_NEAR(true_steps(row->setting) / row->steps, 1, 0.2);
    EXPECT_GE(row->cost, row->steps * row->step) << "the time of published skins is added";
  }

  EXPECT_THROW(cheapest_within(findings, 0.5 * findings.reference_error), Error) << "nothing is claimed below it";
  EXPECT_THROW(most_accurate_within(findings, 1e-9), Error);
}

TEST_F(Accuracy, interrupted_studies_go_on_where_they_were)
{
  interrupt_after = 50;
  EXPECT_FALSE(study().complete);
  const auto kept = [&] { return std::distance(std::filesystem::directory_iterator(plan.folder + "/variants"), {}); };
  const auto some = kept();
  EXPECT_GT(some, 0);
  interrupt_after = 1 << 30;
  const AccuracyFindings findings = study();
  EXPECT_TRUE(findings.complete);
  EXPECT_GT(kept(), some);
  moved = 0;
  const AccuracyFindings again = study();
  EXPECT_EQ(moved, 0) << "no motion is run twice";
  ASSERT_EQ(again.rows.size(), findings.rows.size());
  for (std::size_t r = 0; r < again.rows.size(); ++r)
    EXPECT_TRUE(again.rows[r].error.rms == findings.rows[r].error.rms || std::isnan(again.rows[r].error.rms));
}

TEST_F(Accuracy, motions_of_another_backend_serve_and_are_told)
{
  plan.knobs = { "hourglass" };
  plan.edges = { 4e-3, 2e-3, 1e-3 };
  const AccuracyFindings here = study();
  plan.standard.backend = "reference";
  moved = 0;
  const AccuracyFindings there = study();
  ASSERT_TRUE(there.complete);
  EXPECT_EQ(row_named(there, "standard").error.rms, row_named(here, "standard").error.rms);
  EXPECT_FALSE(std::isnan(row_named(there, "standard").cost));
  const auto told = [&](const std::string& note)
  { return note.find("were computed earlier by backend cpu") != std::string::npos; };
  EXPECT_TRUE(std::any_of(there.notes.begin(), there.notes.end(), told));
}

// Contents of files by name. Files of costs are left out, because costs differ between runs.
std::map<std::string, std::string> files_in(const std::string& folder, const std::string& extension)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == extension)
      files[entry.path().filename()] = text_of(entry.path());
  return files;
}

TEST_F(Accuracy, variants_go_on_from_checkpoints_with_the_same_bits)
{
  plan.knobs = { "hourglass" };
  plan.edges = { 4e-3, 2e-3, 1e-3 };
  plan.folder = folder / "whole";
  ASSERT_TRUE(study().complete);
  const auto whole = files_in(plan.folder + "/variants", ".motion");
  plan.folder = folder / "parts";
  int checkpoints = 0, calls = 0;
  // Each round is interrupted after about 17 calls, within the 30 slices of a variant or while the variant settles.
  for (bool complete = false; !complete; ++calls)
  {
    ASSERT_LT(calls, 1000);
    moved = 0;
    interrupt_after = 17 + calls / 4;
    complete = study().complete;
    const auto kept = files_in(plan.folder + "/variants", ".checkpoint").size();
    EXPECT_LE(kept, 1U);
    checkpoints += static_cast<int>(kept);
  }
  EXPECT_GT(checkpoints, 5);
  EXPECT_TRUE(files_in(plan.folder + "/variants", ".checkpoint").empty());
  EXPECT_TRUE(files_in(plan.folder + "/variants", ".motion") == whole);
}

TEST_F(Accuracy, settings_that_diverge_or_have_no_model_stay_in_the_table)
{
  plan.knobs = { "samples", "hourglass" };
  maker.bake = [](const AccuracySetting& setting)
  {
    Model model = bar(setting);
    if (!setting.profile.assumed_strain)
      model.gravity = { { 0, 0, -1e6 } };
    return model;
  };
  const AccuracyFindings findings = study();
  EXPECT_EQ(row_named(findings, "standard").fault.rfind("unstable: ", 0), 0U) << row_named(findings, "standard").fault;
  EXPECT_EQ(row_named(findings, "2 samples").fault, "no model: no such bar");
  const std::string table = accuracy_table(findings).text();
  EXPECT_NE(table.find("unstable: "), std::string::npos);
  EXPECT_NE(table.find("no model: no such bar"), std::string::npos);
}

TEST_F(Accuracy, settings_that_diverge_while_they_are_timed_stay_in_the_table)
{
  plan.knobs = { "hourglass" };
  study();
  for (const auto& entry : std::filesystem::directory_iterator(plan.folder + "/variants"))
    if (entry.path().extension() == ".cost")
      std::filesystem::remove(entry.path());
  maker.bake = [](const AccuracySetting& setting)
  {
    Model model = bar(setting);
    if (!setting.profile.assumed_strain)
      model.gravity = { { 0, 0, -1e6 } };
    return model;
  };
  EXPECT_EQ(row_named(study(), "standard").fault.rfind("unstable when switched on at once: ", 0), 0U);
}

TEST_F(Accuracy, bad_plans_are_told)
{
  plan.knobs = { "voxel", "colour" };
  EXPECT_NE(fault().find("no knob is called 'colour'; the knobs are voxel, samples"), std::string::npos) << fault();
  plan.knobs = { "voxel" };
  plan.budget = 1e-9;
  EXPECT_NE(fault().find("too small for a comparison"), std::string::npos) << fault();
  plan.edges = { 4e-3, 3e-3, 2e-3 };
  EXPECT_NE(fault().find("it must be smaller than the standard setting's, 2 mm"), std::string::npos) << fault();
  plan.edges = { 1e-3, 2e-3, 4e-3 };
  EXPECT_NE(fault().find("each smaller than the one before"), std::string::npos) << fault();
}

// Findings with given costs and errors instead of measured ones.
AccuracyFindings four_settings()
{
  AccuracyFindings findings;
  const auto add = [&](const std::string& name, double cost, double error)
  {
    AccuracyRow row;
    row.name = name;
    row.cost = cost;
    row.error = { error, 2 * error };
    findings.rows.push_back(row);
  };
  add("fine", 20, 0.1e-3);
  add("draft", 1, 0.8e-3);
  add("wasteful", 5, 0.5e-3);
  add("standard", 4, 0.4e-3);
  add("slightly better", 6, 0.39e-3);
  add("below the reference's error", 90, 0.01e-3);
  AccuracyRow unstable;
  unstable.fault = "unstable";
  findings.rows.push_back(unstable);
  findings.reference_error = 0.1e-3;
  findings.front = pareto_front(findings.rows, findings.standard, findings.reference_error);
  return findings;
}

TEST(AccuracyChoice, the_front_has_what_nothing_beats_in_both_error_and_cost)
{
  EXPECT_EQ(four_settings().front, (std::vector<std::size_t>{ 1, 3, 0 }));
}

TEST(AccuracyChoice, is_the_cheapest_within_an_error_or_the_most_accurate_within_a_cost)
{
  const AccuracyFindings findings = four_settings();
  EXPECT_EQ(cheapest_within(findings, 1e-3).name, "draft");
  EXPECT_EQ(cheapest_within(findings, 0.79e-3).name, "standard");
  EXPECT_EQ(cheapest_within(findings, 0.1e-3).name, "fine");
  EXPECT_THROW(cheapest_within(findings, 0.09e-3), Error) << "below the reference's error nothing is claimed";
  EXPECT_EQ(most_accurate_within(findings, 1).name, "draft");
  EXPECT_EQ(most_accurate_within(findings, 19).name, "standard");
  EXPECT_EQ(most_accurate_within(findings, 1e9).name, "fine");
  EXPECT_THROW(most_accurate_within(findings, 0.9), Error);
}

TEST(AccuracyCost, is_steps_and_published_skins_of_a_simulated_second)
{
  AccuracyPlan plan;
  plan.exact = [](const std::array<double, 3>&) { return std::array<double, 3>{}; };
  plan.frame_rate = 25;
  MeasuredVariant variant;
  variant.motion.phases.resize(2);
  variant.motion.steps = 1000;
  variant.cost.machine = "a bench";
  variant.cost.step = 1e-4;
  variant.cost.skin = 2e-3;
  EXPECT_DOUBLE_EQ(row_of(variant, plan, {}, nullptr).cost, 0.1 + 0.05);
}

TEST(CheapestSetting, may_lie_beside_the_front)
{
  AccuracyFindings findings;
  findings.rows.resize(3);
  const std::pair<double, double> figures[] = { { 0.316e-3, 1.2 }, { 0.315e-3, 2.4 }, { 0.271e-3, 3.1 } };
  for (std::size_t r = 0; r < 3; ++r)
    std::tie(findings.rows[r].error.rms, findings.rows[r].cost) = figures[r];
  findings.front = { 0, 2 };
  EXPECT_EQ(cheapest_within(findings, 0.3155e-3).cost, 2.4);
  EXPECT_EQ(cheapest_within(findings, 1e-3).cost, 1.2);
}

TEST(AccuracyProfileText, is_what_a_scene_file_has)
{
  AccuracyRow row;
  row.setting.profile.voxel.fill(2e-3);
  row.setting.profile.time_step = "assembled";
  row.setting.profile.mass_scaling.kind = MassScaling::Kind::selective;
  row.setting.profile.mass_scaling.time_step = 20e-6;
  row.setting.profile.gaps = "parted";
  row.setting.profile.fibres = "spread";
  row.error.rms = 0.12e-3;
  row.cost = 0.8;
  EXPECT_EQ(
      profile_text(row, "chosen", "a bench"),
      "chosen: {voxel: 2 mm, time_step: assembled, gaps: parted, fibres: spread, mass_scaling: {time_step: 20 us}, "
      "measured: {error: 0.12 mm, cost: 0.8, machine: \"a bench\"}}");
}

}  // namespace
}  // namespace frontalis
