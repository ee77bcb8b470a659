#pragma once

#include "frontalis/model/model.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// What each muscle was commanded to do, over simulated time [s]. The latest command of a muscle replaces the earlier
/// ones, whoever gave them.
class MuscleCommands
{
public:
  /// An activation (0..1) to be reached at a simulated time.
  struct Knot
  {
    double time, activation;
  };
  /// Linear between knots, constant before the first and after the last. Times do not descend.
  using Course = std::vector<Knot>;

  /// All muscles at their tone.
  explicit MuscleCommands(std::shared_ptr<const Model> model);

  /// Sets activations, 0..1, by the names of muscles at once; other muscles go on. Throws an Error that names all
  /// unknown muscles and bad values, and then changes nothing.
  void set(const std::map<std::string, double>& activation, double now);
  /// Takes muscles along courses, which begin at `begin` or later; until then they do as commanded before. Throws the
  /// Errors of set().
  void follow(const std::map<std::string, Course>& courses, double begin, double now);
  /// Takes all muscles to their tone over some seconds. This does not count as a command.
  void relax(double now, double seconds);
  /// Without any command again: all muscles at their tone.
  void clear();

  std::map<std::string, double> at(double time) const;
  /// Whether a muscle is to move after a time.
  bool moving(double time) const;
  /// How long the commands have been silent: since the latest command, or since the end of its courses; 0 if there was
  /// no command.
  double silence(double now) const;

private:
  std::shared_ptr<const Model> model_;
  std::vector<Course> courses_;  ///< one per muscle
  double end_ = 0;               ///< last knot of all courses
  double heard_ = 0;             ///< time of the latest command, or the end of its courses
  bool commanded_ = false;
};

}  // namespace frontalis
