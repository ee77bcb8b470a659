// The plugins in rviz itself. The panel finds the muscles, a slider moves the face, buttons work, and its settings are
// saved. The display draws the skin.

#include <frontalis/SimulationState.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <OgreRenderWindow.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/render_panel.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <sensor_msgs/PointCloud2.h>

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QSlider>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace
{

constexpr std::chrono::minutes limit(4);  // time limit for tests that would never end

/// Runs rviz until a condition holds.
bool run_until(const std::function<bool()>& holds)
{
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!holds())
  {
    if (std::chrono::steady_clock::now() > end)
      return false;
    QApplication::processEvents(QEventLoop::AllEvents, 50);
  }
  return true;
}

class Panel : public testing::Test
{
protected:
  // rviz can be started only once in a process
  static void SetUpTestSuite()
  {
    frame_ = std::make_unique<rviz::VisualizationFrame>();
    frame_->setApp(static_cast<QApplication*>(QApplication::instance()));
    frame_->initialize(QString::fromStdString(ros::package::getPath("frontalis") + "/test/ros/panel/panel.rviz"));
    frame_->show();
  }
  static void TearDownTestSuite() { frame_.reset(); }

  Panel()
  {
    state_ = ros::NodeHandle().subscribe<frontalis::SimulationState>(
        "/face/state", 1, [this](const frontalis::SimulationState::ConstPtr& state) { latest_ = *state; });
  }

  template <typename Widget>
  Widget* find(const char* name)
  {
    Widget* found = nullptr;
    EXPECT_TRUE(run_until([&] { return (found = frame_->findChild<Widget*>(name)) != nullptr; })) << name;
    return found;
  }

  /// Waits until the face has these activations.
  testing::AssertionResult reaches(double left, double right)
  {
    const auto there = [&]
    {
      return latest_.activation.size() == 2 && std::abs(latest_.activation[0] - left) < 2e-3 &&
             std::abs(latest_.activation[1] - right) < 2e-3;
    };
    if (run_until(there))
      return testing::AssertionSuccess();
    return testing::AssertionFailure() << "activations are not " << left << " and " << right;
  }

  /// The share of the picture that is not background [-].
  double drawn()
  {
    Ogre::RenderWindow* const window = frame_->getManager()->getRenderPanel()->getRenderWindow();
    std::vector<std::uint8_t> pixels(3 * std::size_t(window->getWidth()) * window->getHeight());
    const Ogre::PixelBox box(window->getWidth(), window->getHeight(), 1, Ogre::PF_BYTE_RGB, pixels.data());
    window->copyContentsToMemory(box, box);
    std::size_t coloured = 0;  // the background is grey
    for (std::size_t p = 0; p < pixels.size(); p += 3)
      coloured += std::abs(pixels[p] - pixels[p + 2]) > 20 ? 1 : 0;
    return 3.0 * static_cast<double>(coloured) / static_cast<double>(pixels.size());
  }

  static std::unique_ptr<rviz::VisualizationFrame> frame_;
  ros::Subscriber state_;
  frontalis::SimulationState latest_;
};

std::unique_ptr<rviz::VisualizationFrame> Panel::frame_;

TEST_F(Panel, MovesTheFaceAndShowsIt)
{
  auto* const left = find<QSlider>("frontalis_left");
  auto* const right = find<QSlider>("frontalis_right");
  auto* const locked = find<QCheckBox>("locked");
  ASSERT_TRUE(left && right && locked);
  EXPECT_TRUE(locked->isChecked()) << "as test/ros/panel.rviz says";
  EXPECT_DOUBLE_EQ(find<QDoubleSpinBox>("onset")->value(), 0.5);

  left->setValue(700);
  EXPECT_TRUE(reaches(0.7, 0.7));
  EXPECT_TRUE(run_until([&] { return right->value() == 700; }));
  locked->setChecked(false);
  right->setValue(200);
  EXPECT_TRUE(reaches(0.7, 0.2));

  find<QAbstractButton>("expression/wink")->click();
  EXPECT_TRUE(reaches(0.6, 0));
  // sliders that nobody touches show the activations that others command
  EXPECT_TRUE(run_until([&] { return left->value() == 600 && right->value() == 0; }));
  EXPECT_TRUE(run_until([&] { return find<QProgressBar>("speed")->value() > 0; }));

  find<QSlider>("AU1")->setValue(800);
  EXPECT_TRUE(reaches(0.4, 0.4));

  auto* const colour = find<QComboBox>("colour");
  for (const auto& [item, parameter] : { std::pair{ "stress", "skin_field" }, { "activation", "skin_colour" } })
  {
    Q_EMIT colour->textActivated(item);
    std::string value;
    EXPECT_TRUE(run_until([&] { return ros::param::get(std::string("/face/") + parameter, value) && value == item; }))
        << item;
  }

  auto* const pause = find<QAbstractButton>("pause");
  pause->click();
  EXPECT_TRUE(run_until([&] { return latest_.paused && pause->text() == "Play"; }));
  pause->click();
  EXPECT_TRUE(run_until([&] { return !latest_.paused && pause->text() == "Pause"; }));
  find<QAbstractButton>("reset")->click();
  EXPECT_TRUE(reaches(0, 0));

  const std::string saved = testing::TempDir() + "frontalis_panel_test.rviz";
  ASSERT_TRUE(frame_->saveDisplayConfig(QString::fromStdString(saved)));
  std::ifstream file(saved);
  const std::string text{ std::istreambuf_iterator<char>(file), {} };
  EXPECT_NE(text.find("Class: frontalis/FacePanel"), std::string::npos);
  EXPECT_NE(text.find("Left Equals Right: false"), std::string::npos);
  std::remove(saved.c_str());
}

TEST_F(Panel, SaysThatThereIsNoFace)
{
  auto* const name = find<QLineEdit>("face");
  auto* const message = find<QLabel>("message");
  ASSERT_TRUE(name && message);
  const auto call = [&](const char* face)
  {
    name->setText(face);
    Q_EMIT name->editingFinished();
  };
  call("/elsewhere");
  EXPECT_TRUE(run_until([&] { return message->text() == "no face publishes /elsewhere/state"; }));
  EXPECT_EQ(find<QProgressBar>("speed")->value(), 0);
  EXPECT_EQ(frame_->findChild<QSlider*>("frontalis_left"), nullptr);
  call("/face");
  EXPECT_TRUE(find<QSlider>("frontalis_left"));
}

/// The text of a display's status; empty if it has none of this name.
std::string status(const rviz::Display& display, const QString& name)
{
  for (int child = 0; child < display.numChildren(); ++child)
    for (int entry = 0; entry < display.childAt(child)->numChildren(); ++entry)
      if (const rviz::Property* const said = display.childAt(child)->childAt(entry); said->getName() == name)
        return said->getValue().toString().toStdString();
  return {};
}

TEST_F(Panel, TheDisplayDrawsTheSkinAndSaysWhatIsMissing)
{
  rviz::Display* const face = frame_->getManager()->getRootDisplayGroup()->getDisplayAt(0);
  ASSERT_EQ(face->getClassId(), "frontalis/Face");
  EXPECT_TRUE(run_until([&] { return drawn() > 0.02; }));
  EXPECT_TRUE(run_until([&] { return status(*face, "Skin").find(" triangles") != std::string::npos; }));
  face->setEnabled(false);
  EXPECT_TRUE(run_until([&] { return drawn() == 0; }));
  face->setEnabled(true);
  EXPECT_TRUE(run_until([&] { return drawn() > 0.02; }));

  face->subProp("Topic")->setValue("/elsewhere/skin_points");
  EXPECT_TRUE(run_until([&] { return status(*face, "Skin") == "no vertices have come" && drawn() == 0; }));
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "map";
  const ros::Publisher publisher =
      ros::NodeHandle().advertise<sensor_msgs::PointCloud2>("/elsewhere/skin_points", 1, true);
  publisher.publish(cloud);
  EXPECT_TRUE(run_until([&] { return status(*face, "Skin") == "no triangles have come on skin_topology"; }));
  face->subProp("Topic")->setValue("/not-a-name/skin_points");
  EXPECT_TRUE(run_until([&] { return status(*face, "Topic").find("Error subscribing") == 0; }));
}

}  // namespace

int main(int count, char** arguments)
{
  testing::InitGoogleTest(&count, arguments);
  QApplication application(count, arguments);
  ros::init(count, arguments, "panel_test");
  return RUN_ALL_TESTS();
}
