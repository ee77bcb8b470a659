#include "scene/yaml_reader.hpp"

#include "frontalis/error.hpp"
#include "frontalis/suggestion.hpp"

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

bool contains(const std::vector<std::string>& texts, const std::string& text)
{
  return std::find(texts.begin(), texts.end(), text) != texts.end();
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

bool Names::has(const std::string& name) const { return contains(names, name); }

std::vector<std::string> Names::both_sides(const std::string& name) const
{
  if (!has(name) && has(name + "_left") && has(name + "_right"))
    return { name + "_left", name + "_right" };
  return { name };
}

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

std::vector<Node> Node::triple(const std::string& expected) const
{
  if (!given_ || (is_list() && yaml_.size() == 3))
    return entries();
  fault("{}; must be {}", is_list() ? fmt::format("found a list of {}", yaml_.size()) : found(), expected);
  return {};
}

std::optional<std::string> Node::scalar(const std::string& expected) const
{
  if (!given_)
    return std::nullopt;
  if (yaml_.IsScalar() && !yaml_.Scalar().empty())
    return yaml_.Scalar();
  fault(found() + "; must be " + expected);
  return std::nullopt;
}

void Node::check_name(const std::string& name) const
{
  if (!is_name(name))
    fault("'" + name + "' is no name; a name consists of letters, digits and _");
}

std::string Node::text() const { return scalar("a text").value_or(""); }

std::string Node::name() const
{
  const std::optional<std::string> text = scalar("a name");
  if (text)
    check_name(*text);
  return text.value_or("");
}

std::string Node::choice(const std::vector<std::string>& allowed) const
{
  const std::optional<std::string> text = scalar("one of " + list_with_suggestion("", allowed));
  if (!text || contains(allowed, *text))
    return text.value_or("");
  fault("found '" + *text + "'; allowed are " + list_with_suggestion(*text, allowed));
  return {};
}

bool Node::boolean(bool fallback) const
{
  const std::optional<std::string> text = scalar("true or false");
  if (!text || *text == "true" || *text == "false")
    return text ? *text == "true" : fallback;
  fault(found() + "; must be true or false");
  return fallback;
}

int Node::integer(int lower, int upper, int fallback) const
{
  const std::string expected = fmt::format("a whole number from {} to {}", lower, upper);
  const std::optional<std::string> text = scalar(expected);
  if (!text)
    return fallback;
  double value = std::nan("");
  try
  {
    value = parse_quantity(*text, Dimension::number, 1);
  }
  catch (const Error&)
  {
    value = std::nan("");  // leads to the fault below
  }
  if (value >= lower && value <= upper && value == std::floor(value))
    return static_cast<int>(value);
  fault(found() + "; must be " + expected);
  return fallback;
}

double Node::number(Dimension dimension, const Bound& bound, double fallback) const
{
  const std::optional<std::string> text = scalar("a number");
  if (!text)
    return fallback;
  try
  {
    const double value = parse_quantity(*text, dimension, context_->length_unit);
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
  std::array<double, 3> vector = fallback;
  const std::vector<Node> components = triple("a list of three numbers");
  for (std::size_t i = 0; i < components.size(); ++i)
    vector[i] = components[i].number(dimension, bound, fallback[i]);
  return vector;
}

std::optional<std::array<std::optional<double>, 3>> Node::open_vector(Dimension dimension) const
{
  const std::vector<Node> components = triple("a list of three, each a number or null");
  if (components.empty())
    return std::nullopt;
  std::array<std::optional<double>, 3> vector;
  for (std::size_t i = 0; i < 3; ++i)
    if (!components[i].is_null())
    {
      const double value = components[i].number(dimension, any_number, std::nan(""));
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
  // Components are first divided by the largest one, so that no square overflows.
  const double x = vector[0] / largest, y = vector[1] / largest, z = vector[2] / largest;
  const double length = std::sqrt(x * x + y * y + z * z);
  return { x / length, y / length, z / length };
}

std::string Node::reference(const Names& names) const
{
  std::string text = scalar("a name (" + names.kind + ")").value_or("");
  if (!text.empty())
    check_known(text, names);
  return text;
}

void Node::check_known(const std::string& name, const Names& names) const
{
  if (!names.has(name) && names.complete)
    fault("no {0} is called '{1}'; the {0}s are {2}", names.kind, name, list_with_suggestion(name, names.names));
}

std::vector<std::string> Node::references(const Names& names) const
{
  std::vector<std::string> result;
  if (!is_list())
  {
    if (const auto text = scalar("a name (" + names.kind + ") or a list of such names"))
      result = names.both_sides(*text);
    if (result.size() == 1)
      check_known(result[0], names);
    return result;
  }
  if (yaml_.size() == 0)
    fault("found an empty list; must name at least one " + names.kind);
  for (const Node& entry : entries())
  {
    const std::optional<std::string> text = entry.scalar("a name (" + names.kind + ")");
    if (!text)
      continue;
    for (const std::string& name : names.both_sides(*text))
    {
      entry.check_known(name, names);
      if (contains(result, name))
        entry.fault("'" + name + "' is named twice; once is enough");
      else
        result.push_back(name);
    }
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
      context_->faults.add(line, path_, "found a key that is not a text; keys must be texts");
      continue;
    }
    const std::string& key = pair.first.Scalar();
    const std::string path = child_path(key);
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
    node.check_name(key);
  return result;
}

Mapping::Mapping(const Node& node) : node_(node), pairs_(node.pairs()) {}

Mapping::~Mapping()
{
  if (!reports_unknown_keys_)
    return;
  for (const auto& [key, node] : pairs_)
    if (!contains(asked_, key))
      node.fault(!key.empty() && key[0] >= '0' && key[0] <= '9'
                     ? "no key; if this is a number with a comma, write a decimal point, as in 1.5"
                     : "unknown key; allowed are " + list_with_suggestion(key, asked_));
}

Node Mapping::optional(const std::string& key)
{
  asked_.push_back(key);
  for (const auto& pair : pairs_)
    if (pair.first == key)
      return pair.second;
  return Node(node_.child_path(key), node_.line(), node_.context());
}

Node Mapping::required(const std::string& key, const std::string& expected)
{
  Node node = optional(key);
  // A value that is not a mapping has been reported already.
  if (!node.given() && node_.is_mapping())
    node.fault("missing; must be " + expected);
  return node;
}

}  // namespace frontalis
