#include "ros/rviz/face_panel.hpp"

#include "ros/rviz/muscle_names.hpp"

#include <dynamic_reconfigure/Reconfigure.h>
#include <frontalis/ActionUnits.h>
#include <frontalis/Expression.h>
#include <frontalis/MuscleActivation.h>
#include <pluginlib/class_list_macros.hpp>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QSlider>
#include <QTabWidget>
#include <QTimer>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr int full = 1000;                    // value of a slider at activation 1
constexpr std::chrono::seconds untouched(1);  // time after an edit until a slider shows the face's activation again

}  // namespace

FacePanel::FacePanel(QWidget* parent)
    : rviz::Panel(parent),
      face_(new QLineEdit("/face")),
      locked_(new QCheckBox("left = right")),
      pause_(new QPushButton("Pause")),
      colour_(new QComboBox),
      onset_(new QDoubleSpinBox),
      expressions_(new QGridLayout),
      muscles_(new QGridLayout),
      units_(new QGridLayout),
      tabs_(new QTabWidget),
      speed_(new QProgressBar),
      energy_(new QLabel),
      message_(new QLabel)
{
  auto* const top = new QHBoxLayout;
  top->addWidget(new QLabel("Face"));
  top->addWidget(face_);
  top->addWidget(pause_);
  auto* const reset = new QPushButton("Reset");
  top->addWidget(reset);

  auto* const colours = new QHBoxLayout;
  colours->addWidget(new QLabel("Colour"));
  colour_->addItems({ "skin", "displacement", "activation", "strain", "stress", "lines" });
  colours->addWidget(colour_);
  colours->addStretch();
  colours->addWidget(locked_);

  auto* const expressions = new QGroupBox("Expressions");
  auto* const expressions_box = new QVBoxLayout(expressions);
  auto* const blend = new QFormLayout;
  onset_->setRange(0, 10);
  onset_->setSingleStep(0.1);
  onset_->setValue(0.3);
  onset_->setSuffix(" s");
  blend->addRow("within", onset_);
  expressions_box->addLayout(blend);
  expressions_box->addLayout(expressions_);

  muscles_->setColumnStretch(1, 1);
  muscles_->setColumnStretch(2, 1);
  units_->setColumnStretch(1, 1);
  for (const auto& [layout, title] : { std::pair{ muscles_, "Muscles (left, right)" }, { units_, "Action units" } })
  {
    auto* const scroll = new QScrollArea;
    auto* const area = new QWidget;
    area->setLayout(layout);
    scroll->setWidget(area);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setMinimumHeight(200);
    tabs_->addTab(scroll, title);
  }

  speed_->setRange(0, 150);
  speed_->setFormat("real-time factor %v %");
  message_->setWordWrap(true);

  auto* const all = new QVBoxLayout(this);
  all->addLayout(top);
  all->addLayout(colours);
  all->addWidget(speed_);
  all->addWidget(energy_);
  all->addWidget(message_);
  all->addWidget(expressions);
  all->addWidget(tabs_, 1);

  for (const auto& [widget, name] : { std::pair<QWidget*, const char*>{ face_, "face" },
                                      { locked_, "locked" },
                                      { pause_, "pause" },
                                      { reset, "reset" },
                                      { colour_, "colour" },
                                      { onset_, "onset" },
                                      { tabs_, "tabs" },
                                      { speed_, "speed" },
                                      { message_, "message" } })
    widget->setObjectName(name);

  connect(face_, &QLineEdit::editingFinished, this, &FacePanel::connect_to_face);
  connect(face_, &QLineEdit::editingFinished, this, &FacePanel::configChanged);
  connect(locked_, &QCheckBox::toggled, this, [this] { Q_EMIT configChanged(); });
  connect(pause_, &QPushButton::clicked, this,
          [this]
          {
            std_srvs::SetBool request;
            request.request.data = !paused_;
            call("pause", request);
          });
  connect(reset, &QPushButton::clicked, this, [this] { call("reset", std_srvs::Trigger()); });
  connect(colour_, &QComboBox::textActivated, this, &FacePanel::set_colour);
  auto* const timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, [this] { poll(); });
  timer->start(200);
  connect_to_face();
}

void FacePanel::load(const rviz::Config& config)
{
  rviz::Panel::load(config);
  QString face;
  bool locked = false;
  float onset = 0;
  if (config.mapGetString("Face", &face))
    face_->setText(face);
  if (config.mapGetBool("Left Equals Right", &locked))
    locked_->setChecked(locked);
  if (config.mapGetFloat("Onset", &onset))
    onset_->setValue(onset);
  int tab = 0;
  if (config.mapGetInt("Tab", &tab))
    tabs_->setCurrentIndex(tab);
  connect_to_face();
}

void FacePanel::save(rviz::Config config) const
{
  rviz::Panel::save(config);
  config.mapSetValue("Face", face_->text());
  config.mapSetValue("Left Equals Right", locked_->isChecked());
  config.mapSetValue("Onset", onset_->value());
  config.mapSetValue("Tab", tabs_->currentIndex());
}

void FacePanel::connect_to_face()
{
  state_.shutdown();
  show_no_face();
  const std::string face = face_->text().toStdString();
  try
  {
    if (face.empty())
      throw ros::InvalidNameException("it is empty");
    activation_ = handle_.advertise<MuscleActivation>(face + "/muscle_activation", 10);
    action_units_ = handle_.advertise<ActionUnits>(face + "/action_units", 10);
    expression_ = handle_.advertise<Expression>(face + "/expression", 10);
    state_ = handle_.subscribe<SimulationState>(face + "/state", 1,
                                                [this](const SimulationState::ConstPtr& state) { on_state(*state); });
  }
  catch (const ros::Exception& error)
  {
    message_->setText(QString::fromStdString("'" + face + "' is no name of a face: " + error.what()));
  }
}

void FacePanel::show_no_face()
{
  message_->setText("no face publishes " + QString::fromStdString(state_.getTopic()));
  energy_->clear();
  speed_->setValue(0);
  if (known_)
    clear_muscles();
}

template <typename Service>
void FacePanel::call(const char* service, const Service& request,
                     std::function<void(const typename Service::Response&)> use)
{
  const std::string name = face_->text().toStdString() + "/" + service;
  calls_.push_back(
      std::async(std::launch::async,
                 [name, request = Service(request), use]() mutable -> std::function<void()>
                 {
                   const bool done = ros::service::exists(name, false) && ros::service::call(name, request);
                   if (!use)
                     return [] {};
                   // a call that failed has an empty response
                   return [use, response = done ? request.response : typename Service::Response()] { use(response); };
                 }));
}

void FacePanel::poll()
{
  for (auto pending = calls_.begin(); pending != calls_.end();)
    if (pending->wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    {
      const auto act = pending->get();
      pending = calls_.erase(pending);
      act();
    }
    else
      ++pending;
  if (state_ && state_.getNumPublishers() == 0)
    return show_no_face();
  if (known_ || asked_ || !state_)
    return;
  asked_ = true;
  call<ListMuscles>("list_muscles", ListMuscles(),
                    [this](const ListMuscles::Response& face)
                    {
                      asked_ = false;
                      if (face.success)
                        show_muscles(face);
                      else if (!face.message.empty())
                        message_->setText(QString::fromStdString(face.message));
                    });
}

void FacePanel::clear_muscles()
{
  known_ = false;
  slider_of_.clear();
  unit_of_.clear();
  for (QGridLayout* const layout : { muscles_, units_, expressions_ })
    while (QLayoutItem* const item = layout->takeAt(0))
    {
      delete item->widget();
      delete item;
    }
}

void FacePanel::show_muscles(const ListMuscles::Response& face)
{
  clear_muscles();
  known_ = true;
  int row = 0;
  for (const std::string& muscle : face.name)
  {
    if (slider_of_.count(muscle) > 0)
      continue;
    muscles_->addWidget(new QLabel(words(stem(muscle))), row, 0);
    const std::string other = counterpart(muscle);
    add_muscle(muscle, row);
    if (std::find(face.name.begin(), face.name.end(), other) != face.name.end())
      add_muscle(other, row);
    ++row;
  }
  muscles_->setRowStretch(row, 1);
  row = 0;
  for (const std::string& unit : face.action_units)
  {
    QSlider* const slider = unit_of_[unit] = new_slider(unit);
    units_->addWidget(new QLabel(words(unit)), row, 0);
    units_->addWidget(slider, row++, 1);
    connect(slider, &QSlider::valueChanged, this, [this] { on_action_unit(); });
  }
  units_->setRowStretch(row, 1);
  for (const std::string& name : face.expressions)
  {
    auto* const made = new QPushButton(words(name));
    made->setObjectName(QString::fromStdString("expression/" + name));
    connect(made, &QPushButton::clicked, this, [this, name] { express(name); });
    expressions_->addWidget(made, expressions_->count() / 3, expressions_->count() % 3);
  }
}

QSlider* FacePanel::new_slider(const std::string& name)
{
  auto* const slider = new QSlider(Qt::Horizontal);
  slider->setRange(0, full);
  slider->setObjectName(QString::fromStdString(name));
  slider->setToolTip(QString::fromStdString(name));
  return slider;
}

void FacePanel::add_muscle(const std::string& muscle, int row)
{
  QSlider* const slider = slider_of_[muscle] = new_slider(muscle);
  // A muscle that has no side gets a slider across both columns.
  muscles_->addWidget(slider, row, ends_with(muscle, "_right") ? 2 : 1, 1, counterpart(muscle).empty() ? 2 : 1);
  connect(slider, &QSlider::valueChanged, this, [this, muscle] { on_muscle(muscle); });
}

void FacePanel::on_action_unit()
{
  ActionUnits message;
  message.header.stamp = ros::Time::now();
  for (const auto& [unit, slider] : unit_of_)
  {
    message.name.push_back(unit);
    message.intensity.push_back(static_cast<double>(slider->value()) / full);
  }
  action_units_.publish(message);
}

void FacePanel::on_muscle(const std::string& muscle)
{
  edited_ = std::chrono::steady_clock::now();
  MuscleActivation message;
  message.header.stamp = ros::Time::now();
  const int value = slider_of_.at(muscle)->value();
  const auto other = locked_->isChecked() ? slider_of_.find(counterpart(muscle)) : slider_of_.end();
  if (other != slider_of_.end())
  {
    const QSignalBlocker quiet(other->second);
    other->second->setValue(value);
    message.name.push_back(other->first);
  }
  message.name.push_back(muscle);
  message.activation.assign(message.name.size(), static_cast<double>(value) / full);
  activation_.publish(message);
}

void FacePanel::express(const std::string& name)
{
  Expression message;
  message.header.stamp = ros::Time::now();
  message.name = { name };
  message.onset = onset_->value();
  expression_.publish(message);
}

void FacePanel::set_colour(const QString& colour)
{
  const std::string name = colour.toStdString();
  const bool is_field = name == "strain" || name == "stress" || name == "lines";
  dynamic_reconfigure::Reconfigure request;
  auto& parameters = request.request.config.strs;
  parameters.resize(is_field ? 2 : 1);
  parameters.back().name = "skin_field";
  parameters.back().value = name;
  parameters.front().name = "skin_colour";
  parameters.front().value = is_field ? "field" : name;
  call("set_parameters", request);
}

void FacePanel::on_state(const SimulationState& state)
{
  paused_ = state.paused;
  pause_->setText(paused_ ? "Play" : "Pause");
  speed_->setValue(std::clamp(static_cast<int>(std::lround(100 * state.real_time_factor)), 0, speed_->maximum()));
  energy_->setText(QString("%1 s   strain %2 mJ   kinetic %3 mJ")
                       .arg(state.time, 0, 'f', 2)
                       .arg(1e3 * state.internal_energy, 0, 'g', 3)
                       .arg(1e3 * state.kinetic_energy, 0, 'g', 3));
  message_->setText(state.failed ? QString::fromStdString(state.message) : QString::fromStdString(state.backend));
  // If the muscles differ, the face shows another scene.
  if (known_ && (slider_of_.size() != state.name.size() ||
                 std::any_of(state.name.begin(), state.name.end(),
                             [this](const std::string& name) { return slider_of_.count(name) == 0; })))
    return clear_muscles();
  if (std::chrono::steady_clock::now() - edited_ < untouched)
    return;
  for (std::size_t muscle = 0; muscle < std::min(state.name.size(), state.activation.size()); ++muscle)
    if (const auto slider = slider_of_.find(state.name[muscle]);
        slider != slider_of_.end() && !slider->second->isSliderDown())
    {
      const QSignalBlocker quiet(slider->second);
      slider->second->setValue(static_cast<int>(std::lround(full * state.activation[muscle])));
    }
}

}  // namespace frontalis

PLUGINLIB_EXPORT_CLASS(frontalis::FacePanel, rviz::Panel)
