#include "frontalis/ros/muscle_commands.hpp"

#include "frontalis/runner/named_controls.hpp"

#include <algorithm>

namespace frontalis
{

namespace
{

double value_at(const MuscleCommands::Course& course, double time)
{
  const auto after = std::upper_bound(course.begin(), course.end(), time,
                                      [](double t, const MuscleCommands::Knot& knot) { return t < knot.time; });
  if (after == course.begin())
    return course.front().activation;
  const auto& before = *std::prev(after);
  if (after == course.end())
    return before.activation;
  return before.activation +
         (after->activation - before.activation) * (time - before.time) / (after->time - before.time);
}

}  // namespace

MuscleCommands::MuscleCommands(std::shared_ptr<const Model> model) : model_(std::move(model)) { clear(); }

void MuscleCommands::clear()
{
  courses_.clear();
  for (const Muscle& muscle : model_->muscles)
    courses_.push_back({ { 0, muscle.tone } });
  end_ = heard_ = 0;
  commanded_ = false;
}

void MuscleCommands::set(const std::map<std::string, double>& activation, double now)
{
  std::map<std::string, Course> courses;
  for (const auto& [name, value] : activation)
    courses[name] = { { now, value } };
  follow(courses, now, now);
}

void MuscleCommands::follow(const std::map<std::string, Course>& courses, double begin, double now, double end)
{
  std::vector<float> checked(courses_.size());
  for (const auto& [name, course] : courses)
    for (const Knot& knot : course)
      if (!(knot.activation >= 0 && knot.activation <= 1))
        set_activations(*model_, { { name, knot.activation } }, checked);
  std::map<std::string, double> named;
  for (const auto& [name, course] : courses)
    named[name] = 0;
  set_activations(*model_, named, checked);

  commanded_ = true;
  for (std::size_t muscle = 0; muscle < courses_.size(); ++muscle)
  {
    const auto found = courses.find(model_->muscles[muscle].name);
    if (found == courses.end() || found->second.empty())
      continue;
    Course next;
    if (begin > now)
    {
      // Until the new course begins, the muscle follows the course that it had before.
      next.push_back({ now, value_at(courses_[muscle], now) });
      for (const Knot& knot : courses_[muscle])
        if (knot.time > now && knot.time < begin)
          next.push_back(knot);
      next.push_back({ begin, value_at(courses_[muscle], begin) });
    }
    next.insert(next.end(), found->second.begin(), found->second.end());
    courses_[muscle] = std::move(next);
  }
  end_ = std::max(now, end);
  for (const Course& course : courses_)
    end_ = std::max(end_, course.back().time);
  heard_ = end_;
}

void MuscleCommands::relax(double now, double seconds)
{
  for (std::size_t muscle = 0; muscle < courses_.size(); ++muscle)
    courses_[muscle] = { { now, value_at(courses_[muscle], now) }, { now + seconds, model_->muscles[muscle].tone } };
  end_ = now + seconds;
}

std::map<std::string, double> MuscleCommands::at(double time) const
{
  std::map<std::string, double> out;
  for (std::size_t muscle = 0; muscle < courses_.size(); ++muscle)
    out[model_->muscles[muscle].name] = value_at(courses_[muscle], time);
  return out;
}

bool MuscleCommands::moving(double time) const { return end_ > time; }

double MuscleCommands::silence(double now) const { return commanded_ ? std::max(0.0, now - heard_) : 0.0; }

}  // namespace frontalis
