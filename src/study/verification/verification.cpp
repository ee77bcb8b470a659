#include "frontalis/study/verification.hpp"

#include "frontalis/error.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

namespace frontalis
{

std::vector<VerificationCase> verification_cases(const BakeScene& bake)
{
  const auto baked = [&bake](void (&run)(const Backend&, const BakeScene&, Finding&))
  { return [&run, bake](const Backend& backend, Finding& finding) { run(backend, bake, finding); }; };
  return { { "rigid_motion", true, verify_rigid_motion },
           { "affine_motion", true, verify_affine_motion },
           { "energy_gradient", true, verify_energy_gradient },
           { "uniaxial_stretch", true, verify_uniaxial_stretch },
           { "orthotropic_skin", true, verify_orthotropic_skin },
           { "simple_shear", true, verify_simple_shear },
           { "active_bar", true, verify_active_bar },
           { "published_bar", true, verify_published_bar },
           { "cantilever", true, verify_cantilever },
           { "vibration", true, verify_vibration },
           { "convergence", true, verify_convergence },
           { "cook_membrane", true, verify_cook },
           { "staircase", false, verify_staircase },
           { "attachment", false, baked(verify_attachment) },
           { "fitted_layers", false, baked(verify_fitted_layers) },
           { "free_sides", false, baked(verify_free_sides) },
           { "wrinkling", true, verify_wrinkling },
           { "shell", true, baked(verify_shell) },
           { "pinched_shell", false, baked(verify_pinched_shell) },
           { "wrinkle", false, baked(verify_wrinkle) },
           { "viscosity", true, verify_viscosity },
           { "hertz", false, verify_hertz },
           { "contact_pressure", true, verify_contact_pressure },
           { "contact_impact", true, verify_contact_impact },
           { "contact_wrench", true, verify_contact_wrench },
           { "contact_incline", true, verify_contact_incline },
           { "self_contact", false, verify_self_contact },
           { "energy_balance", true, verify_energy_balance },
           { "precision", false, verify_precision },
           { "heart_beam", false, verify_heart_beam },
           { "heart_ellipsoid", false, verify_heart_ellipsoid },
           { "calculix", false, verify_calculix } };
}

Plot convergence_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                      const std::vector<double>& x_ticks, const std::array<double, 2>& x_range, bool y_log)
{
  Plot plot{ title, x_label, y_label };
  plot.x_log = true;
  plot.y_log = y_log;
  plot.x_ticks = x_ticks;
  plot.x_range = x_range;
  plot.key = "below";
  return plot;
}

std::string findings_json(const Findings& findings)
{
  const double none = std::nan("");
  Table table({ "case", "check", "unit", "expected", "found", "error", "bound", "relative", "verdict" });
  for (const auto& [name, finding] : findings)
  {
    for (const auto& check : finding.checks)
      table.add({ name, check.name, check.unit, check.expected, check.found, check.error(), check.bound,
                  check.relative ? "yes" : "no", check.verdict() });
    if (!finding.skipped.empty())
      table.add({ name, finding.skipped, "", none, none, none, none, "", "skipped" });
  }
  return table.json();
}

namespace
{

struct CaseText
{
  std::string title, before, after;  // markdown before and after the figures
};

// The sections of text.md by the names of their cases; empty if the file is missing. A section begins with the name and
// the title of its case; what follows its second heading stands after the figures. The text above all sections, with
// the title and the summary of the manual, has the name "".
std::map<std::string, CaseText> read_texts(const std::string& path)
{
  std::ifstream file(path);
  std::map<std::string, CaseText> texts;
  if (!file)
    return texts;
  CaseText* text = &texts[""];
  std::string* part = &text->before;
  for (std::string line; std::getline(file, line);)
    if (const std::size_t colon = line.find(": "); line.rfind("## ", 0) == 0 && colon != std::string::npos)
    {
      text = &texts[line.substr(3, colon - 3)];
      text->title = line.substr(colon + 2);
      part = &text->before;
    }
    else if (line.rfind("### ", 0) == 0)
      part = &text->after;
    else if (!line.empty() || !part->empty())
      *part += line + '\n';
  for (auto& [name, of_case] : texts)
    for (std::string* const end : { &of_case.before, &of_case.after })
      end->erase(end->find_last_not_of('\n') + 1);
  return texts;
}

// A table under its caption. Browsers hide a table of more than eight rows until a reader clicks on the caption.
std::string captioned(const std::string& caption, const Table& table)
{
  const std::string rows = table.markdown();
  if (std::count(rows.begin(), rows.end(), '\n') <= 10)
    return "\n" + caption + ":\n\n" + rows;
  return "\n<details><summary>" + caption + "</summary>\n\n" + rows + "\n</details>\n";
}

}  // namespace

void write_manual(const Findings& findings, const std::string& path)
{
  const std::filesystem::path manual(path);
  const auto pictures = manual.parent_path() / manual.stem();
  make_folder(pictures.string());
  const std::map<std::string, CaseText> texts = read_texts((pictures / "text.md").string());
  const auto summary = texts.find("");
  const std::string out =
      (summary == texts.end() ? "# Verification" : summary->second.before) +
      "\n\n## All cases\n\n"
      "A check passes when its error is within its bound; figures without a bound are only *shown*. The table says how "
      "many checks of each case pass, and, in its last column, the largest error of the case as a share of its bound. "
      "Errors and bounds in % are relative. Long tables are folded: click on their captions.\n\n"
      "    ./dev cli verify --markdown doc/verification.md           # writes this page anew\n\n"
      "The texts are from `doc/verification/text.md`. The figures are from one run of this command, or from "
      "later runs of single cases, which renewed their sections.\n";
  Table overview({ "case", "checks", "passed", "most of a bound used [%]" });
  std::string sections;
  for (const auto& [name, finding] : findings)
  {
    const CaseText bare{ name, {}, {} };
    const auto found = texts.find(name);
    if (found == texts.end() && !texts.empty())
      throw Error((pictures / "text.md").string() + ": has no section '## " + name + ": TITLE'");
    const CaseText& text = texts.empty() ? bare : found->second;
    const auto& checks = finding.checks;
    const auto is_bounded = [](const Check& check) { return !std::isnan(check.bound); };
    const auto passes = [&](const Check& check) { return is_bounded(check) && check.passed(); };
    double used = std::nan("");  // the largest error divided by its bound
    for (const Check& check : checks)
      used = check.bound > 0 ? std::fmax(used, check.error() / check.bound) : used;
    overview.add({ "[" + text.title + "](#" + name + ")",
                   static_cast<double>(std::count_if(checks.begin(), checks.end(), is_bounded)),
                   static_cast<double>(std::count_if(checks.begin(), checks.end(), passes)),
                   std::isnan(used) ? "" : fmt::format("{:.2g}", 100 * used) });
    sections += "\n## " + text.title + "\n\n<a id=\"" + name + "\"></a>\n" + text.before + "\n";
    if (!finding.skipped.empty())
      sections += "\nSkipped: " + finding.skipped + "\n";
    Table table({ "check", "unit", "expected", "got", "error", "bound", "" });
    for (const Check& check : checks)
      table.add({ check.name, check.unit, check.expected, check.found, check.error_text(check.error()),
                  check.error_text(check.bound), check.verdict() });
    if (!checks.empty())
      sections += captioned("Checks", table);
    for (const auto& [caption, figures] : finding.tables)
      sections += captioned(caption, figures);
    sections += write_plots(finding.plots, pictures.string());
    if (!text.after.empty())
      sections += "\n" + text.after + "\n";
  }
  write_text(path, wrapped(out + "\n" + overview.markdown() + sections));
}

}  // namespace frontalis
