#include "activation_list.hpp"

#include "command.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace frontalis
{
namespace
{

template <class Named>
std::string names_of(const std::vector<Named>& all)
{
  std::string text;
  for (const Named& one : all)
    text += (text.empty() ? "" : ", ") + one.name;
  return text.empty() ? "none" : text;
}

double parse_value(const std::string& entry, const std::string& text)
{
  double value = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end)
    throw WrongUsage("--activate: '" + entry + "' has no number behind '='; write MUSCLE=VALUE,MUSCLE=VALUE");
  return value;
}

void apply_expression(const Model& model, const std::string& name, std::vector<float>& activation)
{
  if (name.empty() || name == "relax")
    return;
  for (const Model::Expression& expression : model.expressions)
    if (expression.name == name)
    {
      for (const auto& [muscle, value] : expression.activation)
        activation[static_cast<std::size_t>(muscle)] = value;
      return;
    }
  throw Error("no expression is called '" + name + "'; there is relax, " + names_of(model.expressions));
}

}  // namespace

std::map<std::string, double> parse_activation_list(const std::string& text)
{
  std::map<std::string, double> listed;
  std::size_t begin = 0;
  while (!text.empty() && begin <= text.size())
  {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = text.substr(begin, end - begin);
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0)
      throw WrongUsage("--activate: '" + entry + "' is not written MUSCLE=VALUE");
    const std::string name = entry.substr(0, equals);
    if (!listed.emplace(name, parse_value(entry, entry.substr(equals + 1))).second)
      throw WrongUsage("--activate: '" + name + "' is given twice");
    begin = end + 1;
  }
  return listed;
}

std::vector<float> target_activation(const Model& model, const std::string& expression,
                                     const std::map<std::string, double>& listed)
{
  std::vector<float> activation(model.muscles.size(), 0);
  apply_expression(model, expression, activation);

  std::string unknown;
  for (const auto& [name, value] : listed)
  {
    const auto muscle = std::find_if(model.muscles.begin(), model.muscles.end(),
                                     [&wanted = name](const Muscle& candidate) { return candidate.name == wanted; });
    if (muscle == model.muscles.end())
      unknown += (unknown.empty() ? "'" : ", '") + name + "'";
    else if (!(value >= 0 && value <= 1))
      throw Error("activation of '" + name + "' is " + std::to_string(value) + "; must be from 0 to 1");
    else
      activation[static_cast<std::size_t>(muscle - model.muscles.begin())] = static_cast<float>(value);
  }
  if (!unknown.empty())
    throw Error("no muscle is called " + unknown + "; the muscles are " + names_of(model.muscles));
  return activation;
}

}  // namespace frontalis
