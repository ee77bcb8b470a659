#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/movie.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/fine_lines.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/study/faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

namespace frontalis
{
namespace
{

struct FacesOptions
{
  ModelSource source;
  std::string people;  ///< file of published motions; empty: config/people.yaml
  std::vector<std::string> only;
  bool all_landmarks = false;
  bool measured_only = false;
  std::string json, table, pictures;
  int columns = 6;
  PortraitView view;
  FaceSettings settings;
};

using Pictures = std::vector<std::pair<std::string, std::vector<std::uint8_t>>>;

/// The chosen expressions of the model: first those in the file of published motions, in its order, then the others.
std::vector<std::string> chosen_expressions(const FacesOptions& options, const Model& model,
                                            const std::vector<std::string>& in_order)
{
  if (!options.only.empty())
    return options.only;
  std::vector<std::string> names;
  const auto has = [&](const std::string& name)
  {
    return std::any_of(model.expressions.begin(), model.expressions.end(),
                       [&](const auto& e) { return e.name == name; });
  };
  std::copy_if(in_order.begin(), in_order.end(), std::back_inserter(names), has);
  for (const auto& expression : model.expressions)
    if (std::find(names.begin(), names.end(), expression.name) == names.end())
      names.push_back(expression.name);
  return names;
}

void measure_faces(FacesOptions& options)
{
  if (options.people.empty())
    for (const auto& place : package_places("config/people.yaml", "config/people.yaml", "config/people.yaml"))
      if (options.people.empty() && std::filesystem::exists(place))
        options.people = place.lexically_normal().string();
  if (options.people.empty())
    throw Error("config/people.yaml is not beside the program; --people must name it");
  check_output(options.json);
  check_output(options.table);
  const People people = read_people(options.people);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  const std::vector<std::string> names = chosen_expressions(options, *model, people.order);
  if (!options.pictures.empty())
    make_folder(options.pictures);

  Progress progress;
  std::string running;
  std::optional<Portrait> portrait;
  Pictures pictures;
  options.settings.watch = [&](double done)
  {
    progress.update(running, done);
    if (interrupt_requested())
      throw Interrupted();
  };
  std::unique_ptr<FineLines> fine_lines;
  if (!options.pictures.empty())
  {
    fine_lines = FineLines::make(model, false);
    options.settings.settled = [&](const std::string& name, const SkinState& skin, const Controls& controls)
    {
      if (!portrait)
        portrait.emplace(*model, skin, options.view);
      if (name.empty() && !pictures.empty())
        return;
      SkinState lined = skin;
      if (fine_lines)
        fine_lines->add_settled(lined);
      pictures.emplace_back(name.empty() ? "rest" : name, portrait->draw(lined, controls));
    };
  }
  std::vector<FaceRow> rows;
  std::vector<std::string> faults;
  bool interrupted = false;
  for (const std::string& name : names)
  {
    running = name;
    const auto known = people.expressions.find(name);
    const PublishedExpression nothing;
    try
    {
      const auto found = measure_expression(model, name, known == people.expressions.end() ? nothing : known->second,
                                            options.settings);
      rows.insert(rows.end(), found.begin(), found.end());
    }
    catch (const Interrupted&)
    {
      // The figures of the expressions before are kept.
      interrupted = true;
      break;
    }
    catch (const Error& error)
    {
      // One motion that the guard stops does not lose the figures of the others.
      faults.push_back(fmt::format("{}: {}", name, error.what()));
    }
  }
  progress.clear();
  fmt::print("{}", faces_table(rows, options.all_landmarks).text());
  // What lacks expressions does not replace the whole.
  const auto named = [&](const std::string& path)
  {
    std::error_code code;
    const bool special = std::filesystem::exists(path, code) && !std::filesystem::is_regular_file(path, code);
    return interrupted && !special ? path + ".part" : path;
  };
  if (!options.json.empty())
    write_text(named(options.json), faces_table(rows, true).json());
  if (!options.table.empty())
    write_text(named(options.table), faces_table(rows, options.all_landmarks).markdown());
  if (!options.pictures.empty() && !pictures.empty())
    write_contact_sheet(pictures, options.view, options.columns,
                        options.pictures + (interrupted ? "/faces_part" : "/faces"));
  if (interrupted)
    throw Interrupted();
  const auto compared =
      std::count_if(rows.begin(), rows.end(), [](const FaceRow& row) { return row.most == row.most; });
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const FaceRow& row) { return !row.passed(); });
  const std::string summary =
      fmt::format("{} of {} figures of {} expressions are not as people's", failed, compared, names.size());
  if (!faults.empty())
    throw Error(fmt::format("{}; {} could not be played:\n{}", summary, faults.size(), fmt::join(faults, "\n")));
  if (failed > 0 && !options.measured_only)
    throw Error(summary);
  if (compared == 0 && !options.measured_only)
    throw Error(
        fmt::format("nothing was compared: of no landmark of these expressions {} has a motion of people; "
                    "--measure only measures",
                    options.people));
  fmt::print("{}\n", summary);
}

}  // namespace

void add_faces_command(CLI::App& app)
{
  const auto options = std::make_shared<FacesOptions>();
  CLI::App* command = app.add_subcommand(
      "faces", "play the expressions of a scene or a baked model and compare how landmarks move with people");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("--only", options->only, "expressions to play: NAME,NAME,... (all)")->delimiter(',');
  command->add_option("--people", options->people, "file with the motions of people (config/people.yaml)");
  add_positive(*command, "--seconds", options->settings.seconds, "simulated seconds per expression (1.2)");
  add_ramp(*command, options->settings.ramp, "seconds in which muscles and bones get there (0.1)");
  command->add_flag("--all-landmarks", options->all_landmarks, "list landmarks of which nothing is published, too");
  command->add_flag("--measure", options->measured_only, "only measure: faces unlike people's are no error");
  command->add_option("--json", options->json,
                      "write the figures of all landmarks to this file (FILE.part if interrupted)");
  command->add_option("--table", options->table,
                      "write the table to this file, as markdown (FILE.part if interrupted)");
  CLI::Option* const pictures = command->add_option(
      "--pictures", options->pictures,
      "write a contact sheet to faces.png in this folder (faces_part.png if interrupted; needs gnuplot)");
  add_positive(*command, "--columns", options->columns, "of the contact sheet (6)")->needs(pictures);
  add_view_options(*command, pictures, options->view);
  add_solver_options(*command, options->settings.solver);
  add_scene_options(*command, options->source);
  command->callback([options] { measure_faces(*options); });
}

}  // namespace frontalis
