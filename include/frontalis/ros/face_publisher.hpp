#pragma once

#include "frontalis/ros/conversions.hpp"
#include "frontalis/ros/muscle_lines.hpp"
#include "frontalis/ros/parameters.hpp"
#include "frontalis/ros/skin_muscles.hpp"

#include <frontalis/Probe.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <boost/shared_ptr.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

class WrinkleTopic;

/// Publishes the topics ~skin, ~skin_points, ~skin_field, ~skin_topology, ~landmarks, ~muscles, ~eyes, ~bodies,
/// ~caption, ~wrench/..., ~wrinkles and ~state, and the transforms. A message is built only while its topic has
/// subscribers, and its memory is reused once no subscriber holds it. Only one thread at a time may call these
/// functions, except for wanted_field(), shows_muscles() and shows_bone_forces().
class FacePublisher
{
public:
  /// Advertises the topics; nothing is published yet.
  explicit FacePublisher(ros::NodeHandle private_handle);
  ~FacePublisher();

  /// Sets the model and publishes its topology, its bodies and its eyeballs (latched). If `parent_frame` is not empty,
  /// it also publishes an identity transform from that frame to the face frame. `wrinkles_in`: the part of the skin
  /// whose wrinkles are measured (WrinkleTopic::start()).
  void start(std::shared_ptr<const Model> model, const std::string& face_frame, const std::string& parent_frame,
             const std::string& backend, const std::vector<double>& wrinkles_in);

  /// Chooses what the colours of the skin show, which field is published, and the value that gets the last colour of
  /// the scale (0: a value for each field that suits faces).
  void set_colour(SkinColour colour, SkinField field, double range);
  /// The field that frames must have for the present subscribers; empty if none of them sees it.
  std::optional<SkinField> wanted_field() const;
  /// Whether frames must have displacements, for ~muscles.
  bool shows_muscles() const { return muscles_.getNumSubscribers() > 0; }
  /// Whether frames must have the forces on bones.
  bool shows_bone_forces() const;

  /// Publishes a frame. Returns false and publishes nothing if the skin is not finite. start() must have been called.
  bool publish(const Frame& frame, const ros::Time& stamp, bool paused);

  /// Publishes ~state alone.
  void publish_state(const Frame& frame, const ros::Time& stamp, bool paused);

  /// Fills in what ~probe answers about the skin vertex closest to a point.
  void probe(const SkinState& skin, const geometry_msgs::Point& point, Probe::Response& out) const;

  /// Publishes a failed ~state with this message, for a face that has no model.
  void publish_fault(const std::string& message, const ros::Time& stamp);

  /// Publishes a text above the face (latched), which rviz turns towards the viewer. Before start() it is in the frame
  /// `frame`, at the place where the face will be; later `frame` is not used.
  void publish_caption(const std::string& text, const std::string& frame);

  /// The model that start() was given; null before.
  const Model* model() const { return model_.get(); }

private:
  /// A topic, and the memory of its latest message.
  template <typename Message>
  struct Topic
  {
    Topic() = default;  ///< without a topic: publishes nothing
    Topic(ros::NodeHandle& handle, const std::string& name) : publisher(handle.advertise<Message>(name, 1)) {}

    /// Publishes a message that `fill` fills, if the topic has subscribers. If a subscriber in this process still holds
    /// the latest message, a new one takes its place.
    template <typename Fill>
    void publish(const std::string& frame, const ros::Time& stamp, const Fill& fill);

    ros::Publisher publisher{};
    boost::shared_ptr<Message> message{};
  };

  /// Publishes the markers of bodies and eyeballs.
  void publish_bodies();
  using MarkerNames = std::set<std::pair<std::string, std::int32_t>>;  ///< `ns` and `id` of markers
  /// Adds the removal of markers in `shown` that `markers` do not replace. `shown`: markers that the topic shows;
  /// updated.
  visualization_msgs::MarkerArray replacing(visualization_msgs::MarkerArray markers, MarkerNames& shown) const;
  bool has_shown_field(const Frame& frame) const;
  std::vector<float> shown_values(const Frame& frame) const;

  Topic<visualization_msgs::Marker> skin_;
  Topic<sensor_msgs::PointCloud2> points_, field_;
  Topic<geometry_msgs::PoseArray> landmarks_, landmarks_68_;
  Topic<SimulationState> state_;
  std::vector<Topic<geometry_msgs::WrenchStamped>> wrenches_;  ///< one per entry of shapes_
  mutable std::mutex bones_mutex_;                             ///< protects bone_wrenches_
  std::vector<ros::Publisher> bone_wrenches_;                  ///< topics of wrenches_ that are of bones
  ros::Publisher topology_, bodies_, muscles_, eyes_, caption_;
  MarkerNames shown_bodies_, shown_eyes_, shown_muscles_;
  std::vector<visualization_msgs::Marker> removals_;            ///< of muscles of the face before
  ros::WallTime removals_end_;                                  ///< until when they are sent
  visualization_msgs::MarkerArray body_markers_, eye_markers_;  ///< kept until they are published again
  std::optional<ros::WallTime> bodies_due_{};  ///< when bodies are published again; 0: to be decided at the next frame
  ros::NodeHandle handle_;
  std::unique_ptr<WrinkleTopic> wrinkles_;
  tf2_ros::TransformBroadcaster transforms_;
  ros::Time sent_{ 0, 1 };  ///< stamp of the latest transforms
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  std::shared_ptr<const Model> model_;
  std::string face_frame_;
  std::string backend_;
  std::unique_ptr<SkinShading> shading_;
  std::vector<std::array<float, 3>> rest_;
  std::vector<std::size_t> landmark_vertices_;
  std::vector<std::size_t> standard_landmarks_;
  std::unique_ptr<MuscleLines> lines_;
  bool muscles_are_new_ = false;  ///< whether ~muscles has not shown the muscles of this model yet
  std::unique_ptr<SkinMuscles> skin_muscles_;
  std::atomic<SkinColour> colour_{ SkinColour::skin };
  std::atomic<SkinField> shown_field_{ SkinField::strain };
  double colour_range_ = 0;
  SkinColours colours_;
  std::vector<BodyShape> shapes_;  ///< of bodies that tissue touches, then of bones
  std::vector<geometry_msgs::TransformStamped> frame_transforms_;
};

}  // namespace frontalis
