#include "cli/motion.hpp"

#include "cli/fields.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace frontalis
{
namespace
{

// steps between two looks for Ctrl-C: about a second of a large model
constexpr double steps_per_slice = 4096;

double finite_number(const std::string& text, const std::string& place)
{
  const std::optional<double> value = number_from(text);
  if (!value || !std::isfinite(*value))
    throw Error(place + "found '" + text + "'; must be a number");
  return *value;
}

// the activations of a row, whose columns after the first have the names of muscles
std::vector<float> row_activation(const Model& model, const std::vector<std::string>& header,
                                  const std::vector<double>& row, const std::string& place)
{
  std::map<std::string, double> named;
  for (std::size_t c = 1; c < header.size(); ++c)
    if (!named.emplace(header[c], row[c]).second)
      throw Error(place + "'" + header[c] + "' is there twice; must be there once");
  std::vector<float> activation(model.muscles.size(), 0);
  try
  {
    set_activations(model, named, activation);
  }
  catch (const Error& error)
  {
    throw Error(place + error.what());
  }
  return activation;
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
  const auto header = fields_of(line);
  if (header[0] != "time")
    throw Error(path + ":1: the first column must be called time");
  ActivationCurve curve{ { 0 },
                         { row_activation(model, header, std::vector<double>(header.size(), 0), path + ":1: ") } };
  bool empty = true;
  for (int row = 2; std::getline(file, line); ++row)
  {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const std::string place = fmt::format("{}:{}: ", path, row);
    const auto fields = fields_of(line);
    if (fields.size() != header.size())
      throw Error(fmt::format("{}found {} fields; the header has {}", place, fields.size(), header.size()));
    std::vector<double> numbers;
    numbers.reserve(fields.size());
    for (const std::string& field : fields)
      numbers.push_back(finite_number(field, place));
    const double time = numbers[0];
    if (!(time >= 0) || (!empty && time <= curve.time.back()))
      throw Error(place + "time is " + fields[0] + "; times must ascend from 0");
    empty = false;
    const std::vector<float> activation = row_activation(model, header, numbers, place);
    if (time == 0)
      curve.activation[0] = activation;
    else
    {
      curve.time.push_back(time);
      curve.activation.push_back(activation);
    }
  }
  if (empty)
    throw Error(path + ": has no row below its header");
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

void Motion::advance(double end)
{
  while (time_ < end && go_on_())
    take_slice(std::min(end, time_ + steps_per_slice * solver_.time_step() * scaling_));
}

void Motion::take_slice(double time)
{
  Controls controls = solver_.controls();
  controls.activation = curve_.at(time);
  for (std::size_t b = 0; b < bones_.size(); ++b)
    controls.bone[b] = time < ramp_ ? interpolate({}, bones_[b], time / ramp_) : bones_[b];
  const double seconds = (time - time_) / scaling_;
  if (guard_ != nullptr)
    guard_->advance(seconds, controls);
  else
    solver_.advance(seconds, controls);
  time_ = time;
}

}  // namespace frontalis
