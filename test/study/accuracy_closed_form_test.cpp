#include "files.hpp"
#include "frontalis/error.hpp"
#include "frontalis/study/accuracy.hpp"
#include "study/accuracy/accuracy_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

class ClosedForms : public testing::TestWithParam<std::string>
{
protected:
  ClosedForm form(const std::string& name) const
  {
    for (ClosedForm& form : closed_forms())
      if (form.name == name)
      {
        form.plan.folder = folder.path();
        form.plan.edges.resize(3);
        form.plan.knobs = { "voxel" };
        form.plan.quick = true;
        form.plan.threads = 1;
        return form;
      }
    throw Error("no closed form is called " + name);
  }

  TemporaryFolder folder;
};

AccuracyFindings study(const ClosedForm& form)
{
  return study_accuracy(form.plan, form.maker, [](const std::string&, double, double) { return true; });
}

double error_of(const AccuracyFindings& findings, const std::string& name)
{
  for (const AccuracyRow& row : findings.rows)
    if (row.name == name)
      return row.error.rms;
  throw Error("no row is called " + name);
}

// Each halving of the edge divides the error by about four. Factors from 3 to 6 pass, because at the finest edge the
// neglected nonlinear terms become visible.
TEST_F(ClosedForms, bending_converges_with_the_second_order)
{
  const AccuracyFindings findings = study(form("cantilever"));
  for (const char* const strain : { "", ", assumed strain, assembled" })
  {
    const std::string at_standard = *strain == 0 ? "standard" : "assumed strain, assembled";
    const double coarse = error_of(findings, std::string("4 mm") + strain), middle = error_of(findings, at_standard),
                 fine = error_of(findings, std::string("1 mm") + strain);
    EXPECT_NEAR(std::log2(coarse / middle), 2, 0.25) << strain;
    EXPECT_NEAR(std::log2(middle / fine), 2, 0.4) << strain;
    EXPECT_LT(coarse, 0.05 * findings.motion) << strain;
  }
  EXPECT_EQ(findings.reference_error, 0);
  const std::string report = accuracy_report(findings, "bending");
  EXPECT_NE(report.find("compared with the closed form"), std::string::npos) << report;
  const std::string words = "falls with the voxel edge to the power ";
  int told = 0;
  for (const std::string& note : findings.notes)
    if (const std::size_t at = note.find(words); at != std::string::npos)
    {
      EXPECT_NEAR(std::stod(note.substr(at + words.size())), 2, 0.3) << note;
      ++told;
    }
  EXPECT_EQ(told, 2);
}

TEST_P(ClosedForms, voxels_represent_a_uniform_stretch_exactly)
{
  const AccuracyFindings findings = study(form(GetParam()));
  EXPECT_GT(findings.motion, 1e-3);
  for (const AccuracyRow& row : findings.rows)
    EXPECT_LT(row.error.rms, 1e-5 * findings.motion) << row.name;
  const auto told = [&](const std::string& note) { return note.find("exactly") != std::string::npos; };
  EXPECT_TRUE(std::all_of(findings.notes.begin(), findings.notes.end(), told) && !findings.notes.empty());
}

INSTANTIATE_TEST_SUITE_P(Uniform, ClosedForms, testing::Values("stretched_block", "active_bar"));

TEST_F(ClosedForms, voxels_that_do_not_fit_have_no_model)
{
  ClosedForm cantilever = form("cantilever");
  cantilever.plan.edges = { 3e-3, 2e-3, 1e-3 };  // 3 mm is measured first
  const AccuracyFindings findings = study(cantilever);
  const auto unfit = [](const AccuracyRow& row)
  { return row.fault == "no model: voxels of 3 mm do not fit an edge of 16 mm"; };
  EXPECT_TRUE(std::any_of(findings.rows.begin(), findings.rows.end(), unfit));
  EXPECT_GT(findings.motion, 0);
  EXPECT_LT(error_of(findings, "1 mm"), error_of(findings, "standard"));
}

TEST(Richardson, is_most_cautious_if_the_order_is_not_credible)
{
  EXPECT_NEAR(richardson(2, 1, 3, 2), 1, 1e-12);
  for (const double order : { 0.1, 4.0, double(NAN) })
    EXPECT_GT(richardson(2, 1, 3, order), 7) << order;
}

}  // namespace
}  // namespace frontalis
