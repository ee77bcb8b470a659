#include "cli/activation_list.hpp"

#include "cli/command.hpp"
#include "cli/fields.hpp"

#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cstddef>
#include <set>

namespace frontalis
{

std::map<std::string, double> parse_activation_list(const std::string& text)
{
  std::map<std::string, double> listed;
  for (const std::string& entry : text.empty() ? std::vector<std::string>() : fields_of(text))
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
    const std::string name = text.substr(0, equals);
    std::vector<double> values;
    if (equals != std::string::npos && equals > 0)
      for (const std::string& field : fields_of(text.substr(equals + 1)))
        if (const std::optional<double> value = number_from(field))
          values.push_back(*value);
    if (values.size() != 6 || std::count(text.begin(), text.end(), ',') != 5)
      throw WrongUsage("--bone: '" + text + "' is not written NAME=X,Y,Z,RX,RY,RZ (mm, degrees)");
    if (!given.insert(name).second)
      throw WrongUsage("--bone: '" + name + "' is given twice");
    constexpr double degree = 3.14159265358979323846 / 180;
    set_bone_motion(model, name,
                    rigid_motion({ { values[3] * degree, values[4] * degree, values[5] * degree } },
                                 { { 1e-3 * values[0], 1e-3 * values[1], 1e-3 * values[2] } }),
                    bones);
  }
  return bones;
}

}  // namespace frontalis
