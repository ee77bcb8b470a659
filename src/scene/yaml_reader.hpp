#pragma once

#include "scene/quantity.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Faults of one file, collected so that a user sees all of them at once.
class Faults
{
public:
  explicit Faults(std::string file) : file_(std::move(file)) {}

  void add(int line, const std::string& key, const std::string& fault);
  bool empty() const { return faults_.empty(); }
  /// Whether a fault was found at `key` or below it.
  bool any_at(const std::string& key) const;
  /// One line per fault, FILE:LINE: KEY: fault, in the order of the lines.
  std::string text() const;

private:
  struct Fault
  {
    int line;
    std::string key;
    std::string text;
  };
  std::string file_;
  std::vector<Fault> faults_;
};

struct ReadingContext
{
  Faults faults;
  double length_unit = 1;  ///< unit of lengths given as plain numbers [m]
};

/// Names that a section defines and others refer to.
struct Names
{
  std::string kind;  ///< singular noun for messages, such as "surface"
  std::vector<std::string> names;
  bool complete = true;  ///< false: the section has faults, which may be the reason of unknown names

  bool has(const std::string& name) const;
  /// Returns `name`, or NAME_left and NAME_right if `name` is unknown and these two are known.
  std::vector<std::string> both_sides(const std::string& name) const;
};

/// A value of the file, or an absent one, with its dotted path and line. If the value is absent or wrong, each reading
/// function returns `fallback` or an empty text. For a wrong value it also records a fault.
class Node
{
public:
  Node(const YAML::Node& yaml, std::string path, int line, ReadingContext& context)
      : yaml_(yaml), path_(std::move(path)), line_(line), context_(&context), given_(true)
  {
  }
  /// An absent value.
  Node(std::string path, int line, ReadingContext& context) : path_(std::move(path)), line_(line), context_(&context) {}

  Node(const Node&) = default;
  Node(Node&&) = default;
  ~Node() = default;
  // The assignment of YAML::Node would overwrite the value in the tree.
  Node& operator=(const Node&) = delete;
  Node& operator=(Node&&) = delete;

  bool given() const { return given_; }
  bool is_null() const { return given_ && yaml_.IsNull(); }
  bool is_text() const { return given_ && yaml_.IsScalar(); }
  bool is_list() const { return given_ && yaml_.IsSequence(); }
  bool is_mapping() const { return given_ && yaml_.IsMap(); }
  /// Whether the value is a mapping with that key.
  bool has(const std::string& key) const { return is_mapping() && yaml_[key].IsDefined(); }
  int line() const { return line_; }
  const std::string& path() const { return path_; }
  ReadingContext& context() const { return *context_; }
  void fault(const std::string& text) const { context_->faults.add(line_, path_, text); }
  template <class First, class... Rest>
  void fault(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) const
  {
    fault(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
  }
  /// Whether a fault was found in this value.
  bool faulty() const { return context_->faults.any_at(path_); }

  std::string text() const;
  std::string name() const;  ///< a text that matches [A-Za-z0-9_]+
  /// One of `allowed`.
  std::string choice(const std::vector<std::string>& allowed) const;
  bool boolean(bool fallback) const;
  int integer(int lower, int upper, int fallback) const;
  double number(Dimension dimension, const Bound& bound, double fallback) const;
  std::array<double, 3> vector(Dimension dimension, const Bound& bound, const std::array<double, 3>& fallback) const;
  /// Three numbers, each of which may be null; `std::nullopt` if the value is wrong or absent.
  std::optional<std::array<std::optional<double>, 3>> open_vector(Dimension dimension) const;
  /// Vector of length 1; a zero vector is a fault.
  std::array<double, 3> direction(const std::array<double, 3>& fallback) const;

  /// One of `names`; an unknown name is a fault.
  std::string reference(const Names& names) const;
  /// Records a fault if `name` is not among `names`, unless these are incomplete.
  void check_known(const std::string& name, const Names& names) const;
  /// One of `names`, or a list of different ones. A name without a side may mean both sides: see Names::both_sides().
  std::vector<std::string> references(const Names& names) const;

  /// Entries of a list; a value that is not a list is a fault.
  std::vector<Node> entries() const;
  /// Entries of a mapping; repeated keys and a value that is not a mapping are faults.
  std::vector<std::pair<std::string, Node>> pairs() const;
  /// Like pairs(), but the keys must be names.
  std::vector<std::pair<std::string, Node>> named_pairs() const;

  std::string found() const;  ///< for messages: "found a list", "found 'text'"
  std::string child_path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

private:
  std::vector<Node> triple(const std::string& expected) const;  ///< entries of a list of three, else none
  std::optional<std::string> scalar(const std::string& expected) const;
  void check_name(const std::string& name) const;

  YAML::Node yaml_;
  std::string path_;
  int line_ = 0;
  ReadingContext* context_;
  bool given_ = false;
};

/// A mapping with fixed keys. When the object goes out of scope, each key that was never asked for is recorded as a
/// fault that lists the known keys.
class Mapping
{
public:
  explicit Mapping(const Node& node);
  ~Mapping();
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  bool has(const std::string& key) const { return node_.has(key); }
  Node optional(const std::string& key);
  Node required(const std::string& key, const std::string& expected);
  /// Accepts all other keys: for values whose allowed keys cannot be determined because of a fault.
  void ignore_rest() { reports_unknown_keys_ = false; }

private:
  Node node_;
  std::vector<std::pair<std::string, Node>> pairs_;
  std::vector<std::string> asked_;
  bool reports_unknown_keys_ = true;
};

}  // namespace frontalis
