#include "motion.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

namespace frontalis
{
namespace
{

std::vector<std::string> fields_of(const std::string& line)
{
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();)
  {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = line.find_first_not_of(" \t\r", begin), last = line.find_last_not_of(" \t\r", end - 1);
    fields.push_back(first < end ? line.substr(first, last + 1 - first) : "");
    begin = end + 1;
  }
  return fields;
}

double number(const std::string& text, const std::string& place)
{
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw Error(place + "found '" + text + "'; must be a number");
  return value;
}

// the model's index of each column but the first
std::vector<std::size_t> columns_of(const std::vector<std::string>& header, const Model& model,
                                    const std::string& place)
{
  if (header.empty() || header[0] != "time")
    throw Error(place + "the first column must be called time");
  std::vector<std::size_t> columns;
  for (auto name = header.begin() + 1; name != header.end(); ++name)
  {
    std::string known;
    std::size_t index = 0;
    while (index < model.muscles.size() && model.muscles[index].name != *name)
      known += (known.empty() ? "" : ", ") + model.muscles[index++].name;
    if (index == model.muscles.size())
      throw Error(place + "no muscle is called '" + *name + "'; the muscles are " + (known.empty() ? "none" : known));
    if (std::find(columns.begin(), columns.end(), index) != columns.end())
      throw Error(place + "'" + *name + "' is there twice");
    columns.push_back(index);
  }
  return columns;
}

}  // namespace

std::vector<float> ActivationCurve::at(double seconds) const
{
  const auto after = std::upper_bound(time.begin(), time.end(), seconds) - time.begin();
  if (after == static_cast<std::ptrdiff_t>(time.size()))
    return activation.back();
  std::vector<float> value = activation[after - 1];
  const auto part = static_cast<float>((seconds - time[after - 1]) / (time[after] - time[after - 1]));
  for (std::size_t m = 0; m < value.size(); ++m)
    value[m] += part * (activation[after][m] - value[m]);
  return value;
}

ActivationCurve ramp_to(const std::vector<float>& target, double ramp)
{
  if (ramp <= 0)
    return { { 0 }, { target } };
  return { { 0, ramp }, { std::vector<float>(target.size(), 0), target } };
}

ActivationCurve read_activation_curve(const std::string& path, const Model& model)
{
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line))
    throw Error(path + ": cannot be read, or is empty");
  const auto columns = columns_of(fields_of(line), model, path + ":1: ");
  ActivationCurve curve{ { 0 }, { std::vector<float>(model.muscles.size(), 0) } };
  for (int row = 2; std::getline(file, line); ++row)
  {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const std::string place = path + ":" + std::to_string(row) + ": ";
    const auto fields = fields_of(line);
    if (fields.size() != columns.size() + 1)
      throw Error(place + "found " + std::to_string(fields.size()) + " fields; the header has " +
                  std::to_string(columns.size() + 1));
    const double time = number(fields[0], place);
    if (!(time >= 0) || (row > 2 && time <= curve.time.back()))
      throw Error(place + "time is " + fields[0] + "; times must ascend from 0");
    std::vector<float> activation(model.muscles.size(), 0);
    for (std::size_t c = 0; c < columns.size(); ++c)
    {
      const double value = number(fields[c + 1], place);
      if (!(value >= 0 && value <= 1))
        throw Error(place + "activation of '" + model.muscles[columns[c]].name + "' is " + fields[c + 1] +
                    "; must be from 0 to 1");
      activation[columns[c]] = static_cast<float>(value);
    }
    if (time == 0)
      curve.activation[0] = activation;
    else
    {
      curve.time.push_back(time);
      curve.activation.push_back(activation);
    }
  }
  return curve;
}

void Motion::advance_to(double time)
{
  for (const double knot : curve_.time)
    if (time_ < knot && knot < time)
      advance(knot);
  if (time_ < ramp_ && ramp_ < time)
    advance(ramp_);
  advance(time);
}

void Motion::advance(double time)
{
  Controls controls = solver_.controls();
  controls.activation = curve_.at(time);
  for (std::size_t b = 0; b < bones_.size(); ++b)
    controls.bone[b] = time < ramp_ ? interpolate({}, bones_[b], time / ramp_) : bones_[b];
  solver_.advance((time - time_) / scaling_, controls);
  time_ = time;
}

}  // namespace frontalis
