#pragma once

#include "frontalis/ros/model_source.hpp"

#include <actionlib/server/simple_action_server.h>
#include <frontalis/FitActivationAction.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace frontalis
{

/// The action ~fit_activation, which runs `frontalis fit` as a separate process. A new goal ends the previous one.
class FitAction
{
public:
  /// The face to fit: a scene or a baked model, and options of `frontalis fit` for the backend.
  struct Face
  {
    BakeRequest source;
    std::string model;                 ///< path of a baked model; empty: the model is baked from `source`
    std::vector<std::string> options;  ///< options such as --threads
  };
  /// Throws an Error if there is no face yet.
  using FindFace = std::function<Face()>;
  /// Commands the activations that were found. Returns why the face refuses them; empty if it takes them.
  using Apply =
      std::function<std::string(const std::vector<std::string>& muscles, const std::vector<double>& activations)>;

  FitAction(const ros::NodeHandle& private_handle, FindFace face, Apply apply);
  /// Ends the goal that is under way.
  ~FitAction();
  FitAction(const FitAction&) = delete;
  FitAction& operator=(const FitAction&) = delete;

private:
  void execute(const FitActivationGoalConstPtr& goal);
  FitActivationResult answer(const FitActivationGoal& goal, const Face& face);

  const FindFace face_;
  const Apply apply_;
  std::atomic<bool> stopping_{ false };
  std::atomic<bool> cancelled_{ false };
  actionlib::SimpleActionServer<FitActivationAction> server_;
};

}  // namespace frontalis
