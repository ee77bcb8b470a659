#pragma once

#include "frontalis/model/model.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The commanded activation of each muscle over simulated time [s]. The latest command for a muscle replaces earlier
/// ones, whatever their source.
class MuscleCommands
{
public:
  /// An activation (0..1) to be reached at a simulated time.
  struct Knot
  {
    double time, activation;
  };
  /// An activation over time: linear between knots, constant before the first and after the last. Times do not descend.
  using Course = std::vector<Knot>;

  /// At first all muscles have the activation of their tone.
  explicit MuscleCommands(std::shared_ptr<const Model> model);

  /// Sets activations, 0..1, of the named muscles at once; other muscles keep their courses. Throws an Error that names
  /// all unknown muscles and bad values, and then changes nothing.
  void set(const std::map<std::string, double>& activation, double now);
  /// Lets muscles follow courses from `begin` on. Until then they follow earlier commands. `end`: time at which a
  /// motion of bones ends that the command contains. Throws as set() does.
  void follow(const std::map<std::string, Course>& courses, double begin, double now, double end = 0);
  /// Brings all muscles to their tone within `seconds`. This does not count as a command.
  void relax(double now, double seconds);
  /// Forgets all commands: all muscles are at their tone.
  void clear();

  std::map<std::string, double> at(double time) const;
  /// Whether the activation of a muscle or the pose of a bone changes after a time.
  bool moving(double time) const;
  /// Time since the latest command, or since the end of all courses if that is later; 0 if there was no command.
  double silence(double now) const;

private:
  std::shared_ptr<const Model> model_;
  std::vector<Course> courses_;  ///< one per muscle
  double end_ = 0;               ///< time at which the last course or motion of a bone ends [s]
  double heard_ = 0;             ///< time of the latest command, or of the end of all courses [s]
  bool commanded_ = false;
};

}  // namespace frontalis
