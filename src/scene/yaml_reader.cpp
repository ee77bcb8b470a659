#include "scene/yaml_reader.hpp"

#include "scene/suggestion.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

int line_of(const YAML::Node& yaml, int fallback) { return yaml.Mark().is_null() ? fallback : yaml.Mark().line + 1; }

bool is_name(const std::string& text)
{
  const auto allowed = [](char c)
  { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

}  // namespace

void Faults::add(int line, const std::string& key, const std::string& fault)
{
  faults_.push_back({ line, key, fault });
}

bool Faults::any_at(const std::string& key) const
{
  return std::any_of(
      faults_.begin(), faults_.end(),
      [&](const Fault& fault)
      {
        return fault.key.compare(0, key.size(), key) == 0 &&
               (fault.key.size() == key.size() || fault.key[key.size()] == '.' || fault.key[key.size()] == '[');
      });
}

std::string Faults::text() const
{
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Fault& a, const Fault& b) { return a.line < b.line; });
  std::string text;
  for (const Fault& fault : sorted)
    text += fmt::format("{}{}:{}: {}: {}", text.empty() ? "" : "\n", file_, fault.line, fault.key, fault.text);
  return text;
}

bool Names::has(const std::string& name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

std::string Node::found() const
{
  if (!given_ || yaml_.IsNull())
    return "found nothing";
  if (yaml_.IsSequence())
    return "found a list";
  if (yaml_.IsMap())
    return "found a mapping";
  return "found '" + yaml_.Scalar() + "'";
}

bool Node::is_triple(const std::string& expected) const
{
  if (is_list() && yaml_.size() == 3)
    return true;
  fault("{}; must be {}", is_list() ? fmt::format("found a list of {}", yaml_.size()) : found(), expected);
  return false;
}

bool Node::scalar(std::string& text, const std::string& expected) const
{
  if (!yaml_.IsScalar() || yaml_.Scalar().empty())
  {
    fault(found() + "; must be " + expected);
    return false;
  }
  text = yaml_.Scalar();
  return true;
}

std::string Node::text(const std::string& fallback) const
{
  std::string text;
  return given_ && scalar(text, "a text") ? text : fallback;
}

std::string Node::name() const
{
  std::string text;
  if (!given_ || !scalar(text, "a name"))
    return {};
  if (!is_name(text))
    fault("'" + text + "' is no name; a name consists of letters, digits and _");
  return text;
}

std::string Node::choice(const std::vector<std::string>& allowed) const
{
  std::string text;
  if (!given_ || !scalar(text, "one of " + list_with_suggestion("", allowed)))
    return {};
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end())
    return text;
  fault("found '" + text + "'; allowed are " + list_with_suggestion(text, allowed));
  return {};
}

bool Node::boolean(bool fallback) const
{
  std::string text;
  if (!given_ || !scalar(text, "true or false"))
    return fallback;
  if (text != "true" && text != "false")
  {
    fault(found() + "; must be true or false");
    return fallback;
  }
  return text == "true";
}

int Node::integer(int lower, int upper, int fallback) const
{
  const std::string expected = fmt::format("a whole number from {} to {}", lower, upper);
  std::string text;
  if (!given_ || !scalar(text, expected))
    return fallback;
  std::optional<double> value;
  try
  {
    value = parse_quantity(text, Dimension::number, 1);
  }
  catch (const Error&)
  {
    value.reset();
  }
  if (!value || *value < lower || *value > upper || *value != std::floor(*value))
  {
    fault(found() + "; must be " + expected);
    return fallback;
  }
  return static_cast<int>(*value);
}

double Node::number(Dimension dimension, const Bound& bound, double fallback) const
{
  std::string text;
  if (!given_ || !scalar(text, "a number"))
    return fallback;
  try
  {
    const double value = parse_quantity(text, dimension, context_->length_unit);
    if (bound.holds(value))
      return value;
    fault(found() + "; must be " + bound.text());
  }
  catch (const Error& error)
  {
    fault(error.what());
  }
  return fallback;
}

std::array<double, 3> Node::vector(Dimension dimension, const Bound& bound, const std::array<double, 3>& fallback) const
{
  if (!given_)
    return fallback;
  if (!is_triple("a list of three numbers"))
    return fallback;
  std::array<double, 3> vector = fallback;
  const std::vector<Node> components = entries();
  for (std::size_t i = 0; i < 3; ++i)
    vector[i] = components[i].number(dimension, bound, fallback[i]);
  return vector;
}

std::optional<std::array<std::optional<double>, 3>> Node::open_vector(Dimension dimension) const
{
  if (!given_)
    return std::nullopt;
  if (!is_triple("a list of three, each a number or null"))
    return std::nullopt;
  std::array<std::optional<double>, 3> vector;
  const std::vector<Node> components = entries();
  for (std::size_t i = 0; i < 3; ++i)
    if (!components[i].is_null())
    {
      const double nothing = std::nan("");
      const double value = components[i].number(dimension, any_number, nothing);
      if (std::isnan(value))
        return std::nullopt;
      vector[i] = value;
    }
  return vector;
}

std::array<double, 3> Node::direction(const std::array<double, 3>& fallback) const
{
  const std::array<double, 3> vector = this->vector(Dimension::number, any_number, fallback);
  const double largest = std::max({ std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2]) });
  if (largest == 0)
  {
    fault("found a zero vector; must have a direction");
    return fallback;
  }
  // divided by its largest component first, so that no square overflows
  const double x = vector[0] / largest;
  const double y = vector[1] / largest;
  const double z = vector[2] / largest;
  const double length = std::sqrt(x * x + y * y + z * z);
  return { x / length, y / length, z / length };
}

std::string Node::reference(const Names& names) const
{
  std::string text;
  if (!given_ || !scalar(text, "a name (" + names.kind + ")"))
    return {};
  if (!names.has(text) && names.complete)
    fault("no " + names.kind + " is called '" + text + "'; the " + names.kind + "s are " +
          list_with_suggestion(text, names.names));
  return text;
}

std::vector<std::string> Node::references(const Names& names) const
{
  std::vector<std::string> result;
  if (!given_)
    return result;
  if (!yaml_.IsSequence())
  {
    std::string text;
    if (scalar(text, "a name (" + names.kind + ") or a list of such"))
      result.push_back(reference(names));
    return result;
  }
  if (yaml_.size() == 0)
    fault("found an empty list; must name at least one " + names.kind);
  for (const Node& entry : entries())
  {
    const std::string name = entry.reference(names);
    if (name.empty())
      continue;
    if (std::find(result.begin(), result.end(), name) != result.end())
      entry.fault("'" + name + "' is named twice; once is enough");
    else
      result.push_back(name);
  }
  return result;
}

std::vector<Node> Node::entries() const
{
  std::vector<Node> result;
  if (!given_)
    return result;
  if (!yaml_.IsSequence())
  {
    fault(found() + "; must be a list");
    return result;
  }
  for (std::size_t i = 0; i < yaml_.size(); ++i)
    result.emplace_back(yaml_[i], fmt::format("{}[{}]", path_, i), line_of(yaml_[i], line_), *context_);
  return result;
}

std::vector<std::pair<std::string, Node>> Node::pairs() const
{
  std::vector<std::pair<std::string, Node>> result;
  if (!given_)
    return result;
  if (!yaml_.IsMap())
  {
    fault(found() + "; must be a mapping (key: value)");
    return result;
  }
  for (const auto& pair : yaml_)
  {
    const int line = line_of(pair.first, line_);
    if (!pair.first.IsScalar())
    {
      context_->faults.add(line, path_, "found a key that is no text; keys are texts");
      continue;
    }
    const std::string& key = pair.first.Scalar();
    const std::string path = path_.empty() ? key : path_ + "." + key;
    const auto earlier =
        std::find_if(result.begin(), result.end(), [&](const auto& other) { return other.first == key; });
    if (earlier != result.end())
      context_->faults.add(line, path,
                           fmt::format("given twice, first on line {}; a key may stand once", earlier->second.line()));
    else
      result.emplace_back(key, Node(pair.second, path, line, *context_));
  }
  return result;
}

std::vector<std::pair<std::string, Node>> Node::named_pairs() const
{
  std::vector<std::pair<std::string, Node>> result = pairs();
  for (const auto& [key, node] : result)
    if (!is_name(key))
      node.fault("'" + key + "' is no name; a name consists of letters, digits and _");
  return result;
}

Mapping::Mapping(const Node& node) : node_(node), pairs_(node.pairs()) {}

Mapping::~Mapping()
{
  if (!judged_)
    return;
  for (const auto& [key, node] : pairs_)
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end())
      node.fault("unknown key; allowed are " + list_with_suggestion(key, asked_));
}

bool Mapping::has(const std::string& key) const
{
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const auto& pair) { return pair.first == key; });
}

Node Mapping::optional(const std::string& key)
{
  asked_.push_back(key);
  for (const auto& pair : pairs_)
    if (pair.first == key)
      return pair.second;
  return Node(node_.path().empty() ? key : node_.path() + "." + key, node_.line(), node_.context());
}

Node Mapping::required(const std::string& key, const std::string& expected)
{
  Node node = optional(key);
  // a value that is no mapping at all has been reported already
  if (!node.given() && node_.is_mapping())
    node.fault("missing; must be " + expected);
  return node;
}

}  // namespace frontalis
