#include "frontalis/ros/face_publisher.hpp"

#include "frontalis/error.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "ros/wrinkle_topic.hpp"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace frontalis
{

namespace
{

// values that are drawn in the last colour of the scale
constexpr double displacement_range = 10e-3;  // [m]
constexpr double strain_range = 0.3;
constexpr double stress_range = 20e3;  // [Pa]
constexpr double line_range = 0.2e-3;  // [m]
constexpr double activation_range = 1;

const ros::WallDuration bodies_again(1);  // time after the first frame until the bodies are published again [s]

}  // namespace

template <typename Message>
template <typename Fill>
void FacePublisher::Topic<Message>::publish(const std::string& frame, const ros::Time& stamp, const Fill& fill)
{
  if (publisher.getNumSubscribers() == 0)
    return;
  // Boost reads the count with acquire order: what a former subscriber read is over before the message is filled again.
  if (!message || message.use_count() > 1)
    message = boost::make_shared<Message>();
  message->header.frame_id = frame;
  message->header.stamp = stamp;
  fill(*message);
  publisher.publish(message);
}

FacePublisher::FacePublisher(ros::NodeHandle private_handle)
    : skin_(private_handle, "skin"),
      points_(private_handle, "skin_points"),
      field_(private_handle, "skin_field"),
      landmarks_(private_handle, "landmarks"),
      landmarks_68_(private_handle, "landmarks_68"),
      state_(private_handle, "state"),
      topology_(private_handle.advertise<shape_msgs::Mesh>("skin_topology", 1, true)),
      bodies_(private_handle.advertise<visualization_msgs::MarkerArray>("bodies", 1, true)),
      muscles_(private_handle.advertise<visualization_msgs::MarkerArray>("muscles", 1)),
      eyes_(private_handle.advertise<visualization_msgs::MarkerArray>("eyes", 1, true)),
      caption_(private_handle.advertise<visualization_msgs::Marker>("caption", 1, true)),
      handle_(private_handle),
      wrinkles_(std::make_unique<WrinkleTopic>(private_handle))
{
}

FacePublisher::~FacePublisher() = default;

void FacePublisher::start(std::shared_ptr<const Model> model, const std::string& face_frame,
                          const std::string& parent_frame, const std::string& backend,
                          const std::vector<double>& wrinkles_in)
{
  model_ = std::move(model);
  wrinkles_->start(model_, wrinkles_in);
  face_frame_ = face_frame;
  sent_ = ros::Time(0, 1);
  backend_ = backend;
  const SkinState rest = rest_in_face(*model_);
  rest_ = rest.vertices;
  shading_ = std::make_unique<SkinShading>(
      model_->skin, skin_appearance(model_->landmarks, rest.landmarks, rest_, resting_eyes(*model_)).colours);
  topology_.publish(to_mesh(*model_));
  landmark_vertices_ = landmark_vertices(*model_);
  standard_landmarks_ = standard_landmarks(*model_);
  lines_ = std::make_unique<MuscleLines>(*model_);
  muscles_are_new_ = true;
  skin_muscles_ = std::make_unique<SkinMuscles>(*model_);
  body_markers_ = replacing(to_bodies(*model_, face_frame_), shown_bodies_);
  eye_markers_ = replacing(to_eyeballs(*model_, face_frame_), shown_eyes_);
  publish_bodies();
  bodies_due_ = ros::WallTime();
  shapes_ = body_shapes(*model_);
  const std::vector<BodyShape> bones = bone_shapes(*model_);
  wrenches_.clear();
  for (const BodyShape& shape : shapes_)
  {
    // Tissue does not touch a body that is only shown, such as the back of a head.
    if (shape.only_shown)
    {
      wrenches_.emplace_back();
      continue;
    }
    const bool named_like_bone =
        std::any_of(bones.begin(), bones.end(), [&](const BodyShape& bone) { return bone.name == shape.name; });
    wrenches_.emplace_back(handle_, "wrench/" + shape.name + (named_like_bone ? "_contact" : ""));
  }
  std::vector<ros::Publisher> of_bones;
  of_bones.reserve(bones.size());
  for (const BodyShape& bone : bones)
    of_bones.push_back(wrenches_.emplace_back(handle_, "wrench/" + bone.name).publisher);
  {
    const std::lock_guard<std::mutex> lock(bones_mutex_);
    bone_wrenches_ = std::move(of_bones);
  }
  shapes_.insert(shapes_.end(), bones.begin(), bones.end());
  if (!parent_frame.empty())
  {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = parent_frame;
    transform.child_frame_id = face_frame_;
    transform.transform.rotation.w = 1;
    static_transforms_.sendTransform(transform);
  }
}

void FacePublisher::publish_bodies()
{
  bodies_.publish(body_markers_);
  eyes_.publish(eye_markers_);
}

visualization_msgs::MarkerArray FacePublisher::replacing(visualization_msgs::MarkerArray markers,
                                                         MarkerNames& shown) const
{
  const MarkerNames former = std::exchange(shown, {});
  for (const auto& marker : markers.markers)
    shown.insert({ marker.ns, marker.id });
  // Markers of the scene that was shown before are removed by name: rviz may handle the markers of a message in any
  // order while their frames are new, so that a removal of all markers could remove the new ones.
  for (const auto& [name, id] : former)
  {
    if (shown.count({ name, id }) > 0)
      continue;
    visualization_msgs::Marker& removal = markers.markers.emplace_back();
    removal.header.frame_id = face_frame_;
    removal.ns = name;
    removal.id = id;
    removal.pose.orientation.w = 1;
    removal.action = visualization_msgs::Marker::DELETE;
  }
  return markers;
}

void FacePublisher::set_colour(SkinColour colour, SkinField field, double range)
{
  colour_ = colour;
  shown_field_ = field;
  colour_range_ = range;
}

std::optional<SkinField> FacePublisher::wanted_field() const
{
  const bool colours = skin_.publisher.getNumSubscribers() > 0 || points_.publisher.getNumSubscribers() > 0;
  const bool wanted = field_.publisher.getNumSubscribers() > 0 || (colours && colour_ == SkinColour::field);
  return wanted ? std::make_optional(shown_field_.load()) : std::nullopt;
}

bool FacePublisher::shows_bone_forces() const
{
  const std::lock_guard<std::mutex> lock(bones_mutex_);
  return std::any_of(bone_wrenches_.begin(), bone_wrenches_.end(),
                     [](const ros::Publisher& topic) { return topic.getNumSubscribers() > 0; });
}

// A frame that was made before the field was chosen, or before it had subscribers, has another field or none.
bool FacePublisher::has_shown_field(const Frame& frame) const
{
  return frame.field.size() == frame.skin.vertices.size() && frame.kind_of_field == shown_field_;
}

// The values that the colours show, divided by the value that has the last colour.
std::vector<float> FacePublisher::shown_values(const Frame& frame) const
{
  std::vector<float> values;
  double full = displacement_range;
  if (colour_ == SkinColour::displacement)
    values = distances(frame.skin, rest_);
  else if (colour_ == SkinColour::activation)
  {
    values = skin_muscles_->activation(frame.activation);
    full = activation_range;
  }
  else if (colour_ == SkinColour::field && has_shown_field(frame))
  {
    values = frame.field;
    const SkinField field = frame.kind_of_field;
    full = field == SkinField::strain ? strain_range : field == SkinField::stress ? stress_range : line_range;
  }
  if (colour_range_ > 0)
    full = colour_range_;
  for (float& value : values)
    value /= static_cast<float>(full);
  return values;
}

bool FacePublisher::publish(const Frame& frame, const ros::Time& stamp, bool paused)
{
  if (!is_publishable(frame.skin, *model_))
    return false;

  const SkinState& skin = frame.skin;
  if (skin_.publisher.getNumSubscribers() > 0 || points_.publisher.getNumSubscribers() > 0)
    shading_->colours(skin, shown_values(frame), colours_);
  else
    colours_.clear();
  // A subscriber that came after the colours were decided waits for the next frame.
  if (!colours_.empty())
  {
    skin_.publish(face_frame_, stamp, [&](auto& marker) { to_marker(*model_, colours_, skin, marker); });
    points_.publish(face_frame_, stamp,
                    [&](auto& cloud) { to_point_cloud(skin, distances(skin, rest_), colours_, cloud); });
  }
  if (has_shown_field(frame))
    field_.publish(face_frame_, stamp, [&](auto& cloud) { to_point_cloud(skin, frame.field, {}, cloud); });
  std_msgs::Header header;
  header.frame_id = face_frame_;
  header.stamp = stamp;
  wrinkles_->offer(skin, header);
  geometry_msgs::PoseArray poses;
  to_poses(skin, landmark_vertices_, poses);
  landmarks_.publish(face_frame_, stamp, [&](auto& message) { message.poses = poses.poses; });
  if (!standard_landmarks_.empty())
    landmarks_68_.publish(face_frame_, stamp,
                          [&](auto& message)
                          {
                            message.poses.clear();
                            for (const std::size_t landmark : standard_landmarks_)
                              message.poses.push_back(poses.poses[landmark]);
                          });
  if (shows_muscles() && frame.displacements.size() == model_->nodes.size())
  {
    visualization_msgs::MarkerArray muscles;
    lines_->fill(*model_, frame.displacements, frame.activation, muscles);
    for (auto& marker : muscles.markers)
    {
      marker.header.frame_id = face_frame_;
      marker.header.stamp = stamp;
    }
    // The muscles of the face before are removed for a while, because a message may be lost.
    if (std::exchange(muscles_are_new_, false))
    {
      const auto first = static_cast<std::ptrdiff_t>(muscles.markers.size());
      muscles = replacing(std::move(muscles), shown_muscles_);
      removals_.assign(muscles.markers.begin() + first, muscles.markers.end());
      removals_end_ = ros::WallTime::now() + bodies_again;
    }
    else if (ros::WallTime::now() < removals_end_)
      muscles.markers.insert(muscles.markers.end(), removals_.begin(), removals_.end());
    muscles_.publish(muscles);
  }
  publish_state(frame, stamp, paused);
  const auto publish_wrench = [&](std::size_t entry, const BodyFrame& body)
  {
    const BodyShape& shape = shapes_[entry];
    wrenches_[entry].publish(body_frame(face_frame_, shape), stamp,
                             [&](auto& wrench) { wrench.wrench = to_wrench(*model_, shape, body); });
  };
  for (std::size_t b = 0; b < frame.bodies.size(); ++b)
    publish_wrench(b, frame.bodies[b]);
  const std::size_t first_bone = wrenches_.size() - frame.bones.size();
  // A frame that was made before these topics had subscribers has no forces on bones.
  for (std::size_t b = 0; frame.has_bone_forces && b < frame.bones.size(); ++b)
    publish_wrench(first_bone + b, frame.bones[b]);
  // tf2 warns of transforms that come again with the same stamp, as they would while a simulated clock stands still.
  if (stamp != std::exchange(sent_, stamp))
  {
    to_transforms(*model_, frame, poses, face_frame_, stamp, frame_transforms_);
    transforms_.sendTransform(frame_transforms_);
  }
  // rviz can lose markers that come together with the first transforms of their frames. The bodies are therefore
  // published once more.
  const ros::WallTime now = ros::WallTime::now();
  if (bodies_due_ && bodies_due_->isZero())
    bodies_due_ = now + bodies_again;
  else if (bodies_due_ && now >= *bodies_due_)
  {
    bodies_due_.reset();
    publish_bodies();
    body_markers_.markers.clear();
    eye_markers_.markers.clear();
  }
  return true;
}

void FacePublisher::probe(const SkinState& skin, const geometry_msgs::Point& point, Probe::Response& out) const
{
  const auto distance = [&](const std::array<float, 3>& vertex)
  { return std::hypot(vertex[0] - point.x, vertex[1] - point.y, vertex[2] - point.z); };
  const auto& all = skin.vertices;
  const auto closest =
      std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  const auto vertex = static_cast<std::size_t>(closest - all.begin());
  if (!std::isfinite(point.x + point.y + point.z) || closest == all.end())
    throw Error("the point is not finite, or there is no skin");
  const auto fill = [](auto& to, double x, double y, double z)
  {
    to.x = x;
    to.y = y;
    to.z = z;
  };
  const auto &at = all[vertex], &normal = skin.normals[vertex], &rest = rest_[vertex];
  out.vertex = static_cast<std::uint32_t>(vertex);
  out.distance = distance(at);
  fill(out.position, at[0], at[1], at[2]);
  fill(out.normal, normal[0], normal[1], normal[2]);
  fill(out.displacement, at[0] - rest[0], at[1] - rest[1], at[2] - rest[2]);
}

void FacePublisher::publish_caption(const std::string& text, const std::string& frame)
{
  // Lowest and highest z of the face in its frame [m]. These values serve until there is a model.
  float lower = -0.1f, upper = 0;
  if (!rest_.empty())
  {
    const auto below = [](const auto& a, const auto& b) { return a[2] < b[2]; };
    const auto [lowest, highest] = std::minmax_element(rest_.begin(), rest_.end(), below);
    lower = (*lowest)[2];
    upper = (*highest)[2];
    for (const BodyShape& shape : body_shapes(*model_))
      for (const auto& vertex : shape.surface->vertices)
        upper = std::max(upper, static_cast<float>(model_->to_face(vertex)[2]));
  }
  const double line = 0.045 * double(upper - lower);
  visualization_msgs::Marker marker;
  marker.header.frame_id = model_ ? face_frame_ : frame;  // without a stamp: at the latest transform
  marker.ns = "caption";
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  // rviz refuses an empty text
  marker.action = text.empty() ? visualization_msgs::Marker::DELETE : visualization_msgs::Marker::ADD;
  marker.text = text;
  marker.scale.z = line;
  marker.pose.position.z = double(upper) + 2 * line;
  marker.pose.orientation.w = 1;
  marker.color.r = marker.color.g = marker.color.b = 0.85f;
  marker.color.a = 1;
  caption_.publish(marker);
}

void FacePublisher::publish_state(const Frame& frame, const ros::Time& stamp, bool paused)
{
  state_.publish(face_frame_, stamp,
                 [&](auto& state)
                 {
                   to_state(*model_, frame, state);
                   state.paused = paused;
                   state.backend = backend_;
                 });
}

void FacePublisher::publish_fault(const std::string& message, const ros::Time& stamp)
{
  state_.publish(face_frame_, stamp,
                 [&](auto& state)
                 {
                   state.failed = true;
                   state.message = message;
                 });
}

}  // namespace frontalis
