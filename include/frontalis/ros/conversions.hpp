#pragma once

#include "frontalis/model/body_shape.hpp"
#include "frontalis/runner/runner.hpp"
#include "frontalis/ros/shading.hpp"

#include <frontalis/SimulationState.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Wrench.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

namespace frontalis
{

/// Whether the skin has as many vertices, normals and landmarks as the model, all of them finite.
bool is_publishable(const SkinState& skin, const Model& model);

/// The triangles of the skin, with the vertices at rest in the face frame [m].
shape_msgs::Mesh to_mesh(const Model& model);

/// Red, green and blue, 0..1, of each skin vertex.
using SkinColours = std::vector<std::array<float, 3>>;

/// The skin as a list of triangles in the face frame, with three points and colours per triangle. Fills all but the
/// header.
void to_marker(const Model& model, const SkinColours& colours, const SkinState& skin, visualization_msgs::Marker& out);

/// The distance of each vertex from its position in `rest` [m].
std::vector<float> distances(const SkinState& skin, const std::vector<std::array<float, 3>>& rest);

/// The vertices as points with the fields x, y, z, normal_x, normal_y, normal_z, intensity and rgb, all of type float32
/// (rgb: three bytes in the bits of a float, as in PCL). Without colours, there is no field rgb. Fills all but the
/// header.
void to_point_cloud(const SkinState& skin, const std::vector<float>& intensity, const SkinColours& colours,
                    sensor_msgs::PointCloud2& out);

/// The skin vertex that is closest at rest to each landmark.
std::vector<std::size_t> landmark_vertices(const Model& model);

/// The 68 points of the iBUG 300-W annotation, landmarks ibug_1 to ibug_68, in this order; empty if one is missing.
std::vector<std::size_t> standard_landmarks(const Model& model);

/// One pose per landmark, in the order of the model: x along the outward normal of the skin at the landmark's vertex, z
/// along the skin upwards. Fills all but the header.
void to_poses(const SkinState& skin, const std::vector<std::size_t>& vertices, geometry_msgs::PoseArray& out);

/// One transform per landmark, from `face_frame` to <face_frame>/<landmark>, and one per body and bone.
void to_transforms(const Model& model, const Frame& frame, const geometry_msgs::PoseArray& landmarks,
                   const std::string& face_frame, const ros::Time& stamp,
                   std::vector<geometry_msgs::TransformStamped>& out);

/// Name of the frame of a body that tissue touches, or of a bone. The frame's origin is the body's centre; while the
/// body is at rest, its axes are parallel to those of the face frame.
std::string body_frame(const std::string& face_frame, const BodyShape& shape);
/// The transform from the face frame to the frame of a body.
geometry_msgs::Transform to_transform(const Model& model, const BodyShape& shape, const RigidTransform& pose);
/// Force and torque of the tissue on a body, in the body's frame and about its origin.
geometry_msgs::Wrench to_wrench(const Model& model, const BodyShape& shape, const BodyFrame& body);
/// The surfaces of all bodies, each in the body's own frame, without a time stamp: displays use the latest transform.
/// Those that are only shown, such as the rest of a head, have lit colours at their vertices, as the skin has.
visualization_msgs::MarkerArray to_bodies(const Model& model, const std::string& face_frame);
/// The eyeballs: spheres that tissue slides on and whose bones have names that begin with "eye". Each eyeball has two
/// markers: a sphere about the origin of the bone's frame, and in that frame the iris with its pupil as triangles.
visualization_msgs::MarkerArray to_eyeballs(const Model& model, const std::string& face_frame);

/// The rigid motion that a transform describes. Throws an Error if the length of its quaternion differs from 1 by more
/// than 1e-3.
RigidTransform to_motion(const geometry_msgs::Transform& transform);

/// The state of a frame. Fills all but the header, `paused` and `backend`.
void to_state(const Model& model, const Frame& frame, SimulationState& out);

}  // namespace frontalis
