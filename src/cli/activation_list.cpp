#include "cli/activation_list.hpp"

#include "cli/command.hpp"

#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <set>

namespace frontalis
{
namespace
{

double parse_value(const std::string& entry, const std::string& text)
{
  double value = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end)
    throw WrongUsage("--activate: '" + entry + "' has no number behind '='; write MUSCLE=VALUE,MUSCLE=VALUE");
  return value;
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
  std::vector<float> activation = expression_activation(model, expression.empty() ? "relax" : expression);
  set_activations(model, listed, activation);
  return activation;
}

std::vector<RigidTransform> parse_bone_motions(const Model& model, const std::vector<std::string>& texts)
{
  std::vector<RigidTransform> bones(model.bones.size());
  std::set<std::string> given;
  for (const std::string& text : texts)
  {
    const std::size_t equals = text.find('=');
    std::array<double, 6> values{};
    std::size_t count = 0, begin = equals == std::string::npos ? text.size() : equals + 1;
    for (; count < 6 && begin < text.size(); ++count)
    {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const auto [stopped, fault] = std::from_chars(text.data() + begin, text.data() + end, values[count]);
      if (fault != std::errc() || stopped != text.data() + end)
        break;
      begin = end + 1;
    }
    if (count != 6 || begin <= text.size() || equals == 0)
      throw WrongUsage("--bone: '" + text + "' is not written NAME=X,Y,Z,RX,RY,RZ (mm, degrees)");
    if (!given.insert(text.substr(0, equals)).second)
      throw WrongUsage("--bone: '" + text.substr(0, equals) + "' is given twice");
    constexpr double degree = 3.14159265358979323846 / 180;
    set_bone_motion(model, text.substr(0, equals),
                    rigid_motion({ { values[3] * degree, values[4] * degree, values[5] * degree } },
                                 { { 1e-3 * values[0], 1e-3 * values[1], 1e-3 * values[2] } }),
                    bones);
  }
  return bones;
}

}  // namespace frontalis
