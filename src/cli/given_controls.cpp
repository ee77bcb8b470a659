#include "cli/given_controls.hpp"

#include "cli/command.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/csv.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace frontalis
{
namespace
{

RigidTransform pose_from(const std::array<double, 6>& values)
{
  constexpr double degree = physics::pi / 180;
  return rigid_motion({ { values[3] * degree, values[4] * degree, values[5] * degree } },
                      { { 1e-3 * values[0], 1e-3 * values[1], 1e-3 * values[2] } });
}

// The controls of a row. Columns after the first are muscles or components of bones, such as BONE.x.
Controls row_controls(const Model& model, const std::vector<std::string>& header, const std::vector<double>& row,
                      const std::string& place)
{
  std::map<std::string, double> values;
  for (std::size_t c = 1; c < header.size(); ++c)
    if (!values.emplace(header[c], row[c]).second)
      throw Error(place + "'" + header[c] + "' is there twice; must be there once");
  try
  {
    return value_controls(model, values);
  }
  catch (const Error& error)
  {
    throw Error(place + error.what());
  }
}

}  // namespace

std::map<std::string, double> parse_activation_list(const std::string& text)
{
  std::map<std::string, double> listed;
  for (const std::string& entry : text.empty() ? std::vector<std::string>() : csv_fields(text))
  {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0)
      throw WrongUsage("--activate: '" + entry + "' is not written MUSCLE=VALUE");
    const std::optional<double> value = number_from(entry.substr(equals + 1));
    if (!value)
      throw WrongUsage("--activate: '" + entry + "' has no number after '='; write MUSCLE=VALUE,MUSCLE=VALUE");
    if (!listed.emplace(entry.substr(0, equals), *value).second)
      throw WrongUsage("--activate: '" + entry.substr(0, equals) + "' is given twice");
  }
  return listed;
}

Controls target_controls(const Model& model, const std::string& expression, const std::map<std::string, double>& listed)
{
  Controls controls = expression_controls(model, expression.empty() ? "relax" : expression);
  set_activations(model, listed, controls.activation);
  return controls;
}

void parse_bone_motions(const Model& model, const std::vector<std::string>& texts, std::vector<RigidTransform>& bones)
{
  std::set<std::string> given;
  for (const std::string& text : texts)
  {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::vector<double> values;
    if (equals != std::string::npos && equals > 0)
      for (const std::string& field : csv_fields(text.substr(equals + 1)))
        if (const std::optional<double> value = number_from(field))
          values.push_back(*value);
    if (values.size() != 6 || std::count(text.begin(), text.end(), ',') != 5)
      throw WrongUsage("--bone: '" + text + "' is not written NAME=X,Y,Z,RX,RY,RZ (mm, degrees)");
    if (!given.insert(name).second)
      throw WrongUsage("--bone: '" + name + "' is given twice");
    set_bone_motion(model, name, pose_from({ { values[0], values[1], values[2], values[3], values[4], values[5] } }),
                    bones);
  }
}

ControlCurve ramp_to(const Controls& target, double ramp)
{
  if (ramp <= 0)
    return { { 0 }, { target } };
  const Controls rest{ std::vector<float>(target.activation.size(), 0),
                       std::vector<RigidTransform>(target.bone.size()) };
  return { { 0, ramp }, { rest, target } };
}

ControlCurve with_bones(const ControlCurve& curve, const std::vector<RigidTransform>& targets, double ramp)
{
  ControlCurve out = curve;
  if (std::find(out.time.begin(), out.time.end(), ramp) == out.time.end())
  {
    const auto after = std::upper_bound(out.time.begin(), out.time.end(), ramp) - out.time.begin();
    out.controls.insert(out.controls.begin() + after, curve.at(ramp));
    out.time.insert(out.time.begin() + after, ramp);
  }
  const RigidTransform rest;
  for (std::size_t knot = 0; knot < out.time.size(); ++knot)
    for (std::size_t b = 0; b < targets.size(); ++b)
      if (targets[b] != rest)
        out.controls[knot].bone[b] =
            out.time[knot] < ramp ? interpolate(rest, targets[b], out.time[knot] / ramp) : targets[b];
  return out;
}

ControlCurve read_control_curve(const std::string& path, const Model& model)
{
  CsvReader table(path);
  const auto& header = table.header();
  if (header[0] != "time")
    throw Error(path + ":1: the first column must be called time" +
                (header[0].find_first_of(";\t\"") != std::string::npos
                     ? ", and commas must separate columns: export the table with commas, without quotation marks"
                     : ""));
  ControlCurve curve{ { 0 }, { row_controls(model, header, std::vector<double>(header.size(), 0), path + ":1: ") } };
  bool empty = true;
  while (table.next())
  {
    const std::string place = table.place();
    std::vector<double> numbers(header.size());
    for (std::size_t column = 0; column < header.size(); ++column)
      numbers[column] = table.number(column);
    const double time = numbers[0];
    if (!(time >= 0) || (!empty && time <= curve.time.back()))
      throw Error(place + "time is " + table.fields()[0] + "; times must ascend from 0");
    empty = false;
    // The first knot must be at time 0, even if the table has no row for that time.
    if (time > 0)
    {
      curve.time.push_back(time);
      curve.controls.emplace_back();
    }
    curve.controls.back() = row_controls(model, header, numbers, place);
  }
  if (empty)
    throw Error(path + ": has no row below its header");
  return curve;
}

}  // namespace frontalis
