#include "frontalis/ros/virtual_camera.hpp"

#include "frontalis/physics/number.hpp"
#include "frontalis/ros/conversions.hpp"
#include "ros/marker_meshes.hpp"
#include "ros/parameter_reader.hpp"

#include <fmt/format.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2/LinearMath/Matrix3x3.h>
#include <tf2/LinearMath/Quaternion.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace frontalis
{
namespace
{

constexpr double degree = physics::pi / 180;
constexpr double patience = 0.3;  // longest time to wait for a transform at the stamp of a frame [s of wall time]
constexpr double silence = 30;    // time between two warnings that the face sends nothing [s of wall time]
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

std::array<double, 3> read_vector(ParameterReader& reader, const std::string& key, const std::vector<double>& fallback)
{
  const auto found = reader.value(key, fallback, "a list of three numbers");
  if (found.size() == 3 && std::isfinite(found[0]) && std::isfinite(found[1]) && std::isfinite(found[2]))
    return { found[0], found[1], found[2] };
  reader.add_fault(key, fmt::format("found [{}]; allowed are three finite numbers", fmt::join(found, ", ")));
  return { fallback[0], fallback[1], fallback[2] };
}

sensor_msgs::Image image_of(const std_msgs::Header& header, const PinholeCamera& camera, const std::string& encoding,
                            std::size_t bytes_per_pixel, const void* pixels)
{
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<std::uint32_t>(camera.width);
  image.height = static_cast<std::uint32_t>(camera.height);
  image.encoding = encoding;
  image.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  image.step = static_cast<std::uint32_t>(bytes_per_pixel) * image.width;
  image.data.resize(std::size_t{ image.step } * image.height);
  std::memcpy(image.data.data(), pixels, image.data.size());
  return image;
}

sensor_msgs::CameraInfo info_of(const std_msgs::Header& header, const PinholeCamera& camera)
{
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0);
  info.K = { { camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1 } };
  info.R = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
  info.P = { { camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0 } };
  return info;
}

}  // namespace

VirtualCamera::VirtualCamera(ros::NodeHandle handle, ros::NodeHandle private_handle) : listener_(buffer_)
{
  ParameterReader reader(private_handle);
  frame_ = reader.text("frame", "camera_optical_frame");
  const int width = reader.value("width", 640, "a whole number [pixels]");
  const int height = reader.value("height", 480, "a whole number [pixels]");
  const double field_of_view = reader.value("field_of_view", 35.0, "a number [degrees]");
  samples_ = reader.value("samples", 1, "a whole number");
  if (samples_ < 1 || samples_ > 16)
    reader.add_fault("samples", fmt::format("found {}; allowed is 1 to 16", samples_));
  rate_ = reader.number("rate", 10.0, "a number [1/s]", 0.0, "0 (every frame) or more [1/s]");
  light_.key = read_vector(reader, "light", { 1, -0.7, 0.9 });
  if (light_.key == std::array<double, 3>{})
    reader.add_fault("light", "found no direction; allowed is a vector other than zero");
  const std::string parent = reader.text("parent_frame", "");
  const auto position = read_vector(reader, "position", { 0.55, 0.15, 0 });
  const auto target = read_vector(reader, "look_at", { -0.03, 0, -0.03 });
  const std::string face = reader.text("face", "face") + "/";
  reader.finish();
  camera_ = camera_with(width, height, field_of_view * degree);
  if (!parent.empty())
    place(parent, look_at(position, target));
  private_handle.setParam("label_names", label_names());
  info_ = private_handle.advertise<sensor_msgs::CameraInfo>("camera_info", 1);
  rgb_ = private_handle.advertise<sensor_msgs::Image>("rgb", 1);
  depth_ = private_handle.advertise<sensor_msgs::Image>("depth", 1);
  labels_ = private_handle.advertise<sensor_msgs::Image>("labels", 1);
  points_ = private_handle.advertise<sensor_msgs::PointCloud2>("points", 1);
  landmarks_ = private_handle.advertise<sensor_msgs::PointCloud2>("landmarks", 1);
  subscribe<shape_msgs::Mesh>(handle, face + "skin_topology", &Inputs::topology);
  subscribe<sensor_msgs::PointCloud2>(handle, face + "skin_points", &Inputs::skin);
  subscribe<geometry_msgs::PoseArray>(handle, face + "landmarks", &Inputs::landmarks);
  subscribe<SimulationState>(handle, face + "state", &Inputs::state);
  subscribe<visualization_msgs::MarkerArray>(handle, face + "eyes", &Inputs::eyes);
  subscribe<visualization_msgs::MarkerArray>(handle, face + "bodies", &Inputs::bodies);
  silence_timer_ = handle.createWallTimer(ros::WallDuration(silence), [this](const auto&) { report_silence(); });
}

// publishes the pose of the camera
void VirtualCamera::place(const std::string& parent, const RigidTransform& to_camera)
{
  // the axes of the camera are the rows of the rotation, and the columns of its inverse
  const auto& r = to_camera.rotation;
  const tf2::Matrix3x3 axes(r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]);
  const auto& t = to_camera.translation;
  const tf2::Vector3 at = -(axes * tf2::Vector3(t[0], t[1], t[2]));
  tf2::Quaternion turn;
  axes.getRotation(turn);
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = parent;
  transform.child_frame_id = frame_;
  transform.transform.translation.x = at.x();
  transform.transform.translation.y = at.y();
  transform.transform.translation.z = at.z();
  transform.transform.rotation.x = turn.x();
  transform.transform.rotation.y = turn.y();
  transform.transform.rotation.z = turn.z();
  transform.transform.rotation.w = turn.w();
  broadcaster_.sendTransform(transform);
}

template <class Message>
void VirtualCamera::subscribe(ros::NodeHandle& handle, const std::string& topic,
                              typename Message::ConstPtr Inputs::*input)
{
  const boost::function<void(const typename Message::ConstPtr&)> take = [this, input](const auto& message)
  {
    inputs_.*input = message;
    if (!is_complete())
      return;
    was_complete_ = true;
    if (is_wanted())
      take_picture();
  };
  subscribers_.push_back(handle.subscribe<Message>(topic, 1, take));
}

// whether the latest messages are of one frame of one face
bool VirtualCamera::is_complete() const
{
  const auto& [topology, skin, landmarks, state, eyes, bodies] = inputs_;
  if (!topology || !skin || !landmarks || !state || !eyes || !bodies)
    return false;
  const ros::Time stamp = skin->header.stamp;
  // The state is asked for the names of landmarks alone, and a slow face sends it between frames, too.
  return landmarks->header.stamp == stamp && skin->width > 0 && skin->width == topology->vertices.size() &&
         landmarks->poses.size() == state->landmark.size();
}

bool VirtualCamera::has_listeners() const
{
  const auto is_heard = [](const ros::Publisher* topic) { return topic->getNumSubscribers() > 0; };
  const auto topics = { &info_, &rgb_, &depth_, &labels_, &points_, &landmarks_ };
  return std::any_of(topics.begin(), topics.end(), is_heard);
}

// warns if somebody listens, but the face has sent no whole frame since the latest call
void VirtualCamera::report_silence()
{
  if (std::exchange(was_complete_, false) || is_complete() || !has_listeners())
    return;
  std::string why;
  for (const ros::Subscriber& input : subscribers_)
    if (input.getNumPublishers() == 0)
      why += (why.empty() ? "nobody publishes " : ", ") + input.getTopic();
  if (why.empty())
    why = "its node has not sent a whole frame; it may still be baking its model";
  ROS_WARN("no picture of the face: %s", why.c_str());
}

// whether somebody listens, and the next picture is due
bool VirtualCamera::is_wanted() const
{
  const ros::Time stamp = inputs_.skin->header.stamp;
  // A stamp before the latest one means that the clock has been started again.
  if (stamp == pictured_ || (stamp > pictured_ && rate_ > 0 && (stamp - pictured_).toSec() < (1 - 1e-3) / rate_))
    return false;
  return has_listeners();
}

// vertices and normals of the skin, and the landmarks, of the latest frame
SkinState VirtualCamera::skin() const
{
  SkinState out;
  sensor_msgs::PointCloud2ConstIterator<float> vertex(*inputs_.skin, "x"), normal(*inputs_.skin, "normal_x");
  for (; vertex != vertex.end(); ++vertex, ++normal)
  {
    out.vertices.push_back({ vertex[0], vertex[1], vertex[2] });
    out.normals.push_back({ normal[0], normal[1], normal[2] });
  }
  for (const auto& pose : inputs_.landmarks->poses)
    out.landmarks.push_back({ static_cast<float>(pose.position.x), static_cast<float>(pose.position.y),
                              static_cast<float>(pose.position.z) });
  return out;
}

// Colours and labels follow from the places of landmarks at rest, which are not published. Each place is taken to be
// that of the vertex, at rest, that is closest to the landmark in this frame.
void VirtualCamera::find_appearance(const SkinState& skin, const std::vector<RenderBall>& eyes)
{
  std::vector<std::array<float, 3>> rest;
  for (const auto& p : inputs_.topology->vertices)
    rest.push_back({ static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z) });
  std::vector<std::array<float, 3>> places;
  for (const auto& landmark : skin.landmarks)
  {
    const auto distance = [&](const auto& v)
    { return std::hypot(v[0] - landmark[0], v[1] - landmark[1], v[2] - landmark[2]); };
    const auto closest = std::min_element(skin.vertices.begin(), skin.vertices.end(),
                                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    places.push_back(rest[static_cast<std::size_t>(closest - skin.vertices.begin())]);
  }
  appearance_ = skin_appearance(inputs_.state->landmark, places, rest, eyes);
  triangles_.clear();
  for (const auto& triangle : inputs_.topology->triangles)
  {
    const auto& corners = triangle.vertex_indices;
    triangles_.push_back({ static_cast<std::int32_t>(corners[0]), static_cast<std::int32_t>(corners[1]),
                           static_cast<std::int32_t>(corners[2]) });
  }
  appearance_of_ = { inputs_.topology, inputs_.eyes };  // last: after an exception, the next picture starts anew
}

// Waits for a transform that may come a little later than the messages of its frame. tf2's own waiting does not end
// while a simulated clock stands still. After it has waited in vain, it does not wait again before the missed transform
// or a later one has come, so that a frame that nobody publishes does not hold up the other callbacks of this thread.
RigidTransform VirtualCamera::transform(const std::string& to, const std::string& from, const ros::Time& stamp)
{
  const ros::Time latest;
  ros::Time& missed = missed_[{ to, from }];
  if (missed.isZero() || missed > stamp ||
      (buffer_.canTransform(to, from, latest) && buffer_.lookupTransform(to, from, latest).header.stamp >= missed))
  {
    missed = stamp;
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(patience);
    while (!buffer_.canTransform(to, from, stamp) && ros::WallTime::now() < deadline && ros::ok())
      ros::WallDuration(0.002).sleep();
  }
  const RigidTransform found = to_motion(buffer_.lookupTransform(to, from, stamp).transform);
  missed = ros::Time();
  return found;
}

void VirtualCamera::add_eyes(const std::string& face_frame, const ros::Time& stamp, RenderScene& scene)
{
  for (const visualization_msgs::Marker& marker : inputs_.eyes->markers)
  {
    // Markers with another action remove the eyes of an earlier scene.
    if (marker.action != visualization_msgs::Marker::ADD)
      continue;
    const RigidTransform pose = transform(face_frame, marker.header.frame_id, stamp);
    if (marker.type == visualization_msgs::Marker::TRIANGLE_LIST)
    {
      scene.meshes.push_back(moved(mesh_of_iris(marker), pose));
      continue;
    }
    RenderBall& ball = scene.balls.emplace_back(ball_of(marker));
    ball.centre = pose(ball.centre);
  }
}

void VirtualCamera::add_bodies(const std::string& face_frame, const ros::Time& stamp, RenderScene& scene)
{
  const auto& markers = inputs_.bodies->markers;
  if (body_meshes_of_ != inputs_.bodies)
  {
    body_meshes_.clear();
    std::transform(markers.begin(), markers.end(), std::back_inserter(body_meshes_), mesh_of_body);
    body_meshes_of_ = inputs_.bodies;
  }
  for (std::size_t at = 0; at < markers.size(); ++at)
  {
    const visualization_msgs::Marker& marker = markers[at];
    // Markers with another action remove the bodies of an earlier scene.
    if (marker.action != visualization_msgs::Marker::ADD)
      continue;
    const RigidTransform pose = transform(face_frame, marker.header.frame_id, stamp);
    const RenderMesh& mesh = scene.meshes.emplace_back(moved(body_meshes_[at], pose));
    // An eyeball that lids touch is also a body. Only its ball is drawn.
    const auto is_eyeball = [&mesh](const RenderBall& ball)
    {
      const auto is_within = [&ball](const std::array<float, 3>& v)
      {
        const double x = v[0] - ball.centre[0], y = v[1] - ball.centre[1], z = v[2] - ball.centre[2];
        return std::hypot(x, y, z) < 1.02 * ball.radius;
      };
      return ball.label == eye_label && std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_within);
    };
    if (std::any_of(scene.balls.begin(), scene.balls.end(), is_eyeball))
      scene.meshes.pop_back();
  }
}

void VirtualCamera::take_picture()
{
  const std::string face_frame = inputs_.skin->header.frame_id;
  std_msgs::Header header;
  header.stamp = pictured_ = inputs_.skin->header.stamp;
  header.frame_id = frame_;
  try
  {
    const SkinState skin = this->skin();
    RenderScene scene;
    add_eyes(face_frame, header.stamp, scene);
    if (appearance_of_ != std::make_pair(inputs_.topology, inputs_.eyes))
      find_appearance(skin, scene.balls);
    const std::vector<RenderBall> eyes = scene.balls;
    std::transform(eyes.begin(), eyes.end(), std::back_inserter(scene.balls), socket_of);
    scene.meshes.push_back({ skin.vertices, triangles_, skin.normals, appearance_.colours, appearance_.labels });
    if (appearance_.mouth)
      scene.balls.push_back(*appearance_.mouth);
    add_bodies(face_frame, header.stamp, scene);
    camera_.to_camera = transform(frame_, face_frame, header.stamp);
    const Renderer renderer(scene, camera_);
    publish(renderer.images(light_, samples_), header);
    publish_landmarks(renderer, skin.landmarks, header);
  }
  catch (const std::exception& error)
  {
    if (warning_.passes(10))
      ROS_WARN("no picture of the face: %s", error.what());
  }
}

void VirtualCamera::publish(const Images& images, const std_msgs::Header& header)
{
  std::vector<float> depth = images.depth;
  std::replace(depth.begin(), depth.end(), 0.0F, unknown);
  info_.publish(info_of(header, camera_));
  rgb_.publish(image_of(header, camera_, "rgb8", 3, images.colour.data()));
  depth_.publish(image_of(header, camera_, "32FC1", sizeof(float), depth.data()));
  labels_.publish(image_of(header, camera_, "mono8", 1, images.label.data()));
  if (points_.getNumSubscribers() == 0)
    return;
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.is_dense = false;
  sensor_msgs::PointCloud2Modifier layout(cloud);
  layout.setPointCloud2FieldsByString(2, "xyz", "rgb");
  layout.resize(depth.size());
  cloud.width = static_cast<std::uint32_t>(camera_.width);
  cloud.height = static_cast<std::uint32_t>(camera_.height);
  cloud.row_step = cloud.width * cloud.point_step;
  sensor_msgs::PointCloud2Iterator<float> xyz(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> bgr(cloud, "b");
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel, ++xyz, ++bgr)
  {
    const double z = depth[pixel];
    const auto column = static_cast<int>(pixel) % camera_.width, row = static_cast<int>(pixel) / camera_.width;
    xyz[0] = static_cast<float>((column - camera_.cx) / camera_.fx * z);
    xyz[1] = static_cast<float>((row - camera_.cy) / camera_.fy * z);
    xyz[2] = depth[pixel];
    for (std::size_t channel = 0; channel < 3; ++channel)
      bgr[static_cast<int>(channel)] = images.colour[pixel][2 - channel];
  }
  points_.publish(cloud);
}

void VirtualCamera::publish_landmarks(const Renderer& renderer, const std::vector<std::array<float, 3>>& landmarks,
                                      const std_msgs::Header& header)
{
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.height = 1;
  cloud.is_dense = true;
  sensor_msgs::PointCloud2Modifier layout(cloud);
  constexpr auto number = sensor_msgs::PointField::FLOAT32;
  layout.setPointCloud2Fields(6, "x", 1, number, "y", 1, number, "z", 1, number, "u", 1, number, "v", 1, number,
                              "visible", 1, number);
  layout.resize(landmarks.size());
  sensor_msgs::PointCloud2Iterator<float> row(cloud, "x");
  for (const auto& landmark : landmarks)
  {
    const std::array<double, 3> p = camera_.to_camera(landmark);
    const bool ahead = p[2] > 0;
    const std::array<double, 2> pixel = ahead ? camera_.project(p) : std::array<double, 2>{ unknown, unknown };
    for (int i = 0; i < 3; ++i)
      row[i] = static_cast<float>(p[static_cast<std::size_t>(i)]);
    row[3] = static_cast<float>(pixel[0]);
    row[4] = static_cast<float>(pixel[1]);
    row[5] = renderer.sees({ landmark[0], landmark[1], landmark[2] }) ? 1.0F : 0.0F;
    ++row;
  }
  landmarks_.publish(cloud);
}

}  // namespace frontalis
