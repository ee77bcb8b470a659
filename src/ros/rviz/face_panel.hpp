#pragma once

#include <frontalis/ListMuscles.h>
#include <frontalis/SimulationState.h>
#include <ros/ros.h>
#include <rviz/panel.h>

#include <chrono>
#include <functional>
#include <future>
#include <list>
#include <map>
#include <string>
#include <vector>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QSlider;
class QTabWidget;

namespace frontalis
{

/// A panel of rviz that moves a face and shows its state. It has a slider per muscle (left and right in one row) and
/// per action unit, buttons for expressions, pause and reset, a choice of skin colours, and gauges. It talks to the
/// face by topics and services alone. Each slider's QObject name is that of its muscle or action unit.
class FacePanel : public rviz::Panel
{
  Q_OBJECT

public:
  explicit FacePanel(QWidget* parent = nullptr);

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

private:
  /// Subscribes and advertises under the name of the face, and forgets its muscles.
  void connect_to_face();
  void show_no_face();
  /// Handles finished calls of services, and asks for the muscles of the face if they are unknown.
  void poll();
  void show_muscles(const ListMuscles::Response& face);
  QSlider* new_slider(const std::string& name);
  void add_muscle(const std::string& muscle, int row);
  void clear_muscles();
  void on_state(const SimulationState& state);
  void on_muscle(const std::string& muscle);
  void on_action_unit();
  void express(const std::string& name);
  /// Calls a service in another thread, because a face may answer late. `use` gets the answer later, in this thread.
  template <typename Service>
  void call(const char* service, const Service& request,
            std::function<void(const typename Service::Response&)> use = {});
  void set_colour(const QString& colour);  ///< one of the entries of colour_

  QLineEdit* face_;
  QCheckBox* locked_;
  QPushButton* pause_;
  QComboBox* colour_;
  QDoubleSpinBox* onset_;
  QGridLayout* expressions_;
  QGridLayout* muscles_;
  QGridLayout* units_;
  QTabWidget* tabs_;
  QProgressBar* speed_;
  QLabel* energy_;
  QLabel* message_;
  std::map<std::string, QSlider*> slider_of_;  ///< sliders by the name of the muscle
  std::map<std::string, QSlider*> unit_of_;    ///< sliders by the name of the action unit

  ros::NodeHandle handle_;
  ros::Publisher activation_, action_units_, expression_;
  ros::Subscriber state_;
  bool paused_ = false;
  bool known_ = false;                              ///< whether the muscles and expressions of the face are shown
  bool asked_ = false;                              ///< whether a call of ~list_muscles is under way
  std::chrono::steady_clock::time_point edited_{};  ///< when a slider was moved last
  std::list<std::future<std::function<void()>>> calls_;
};

}  // namespace frontalis
