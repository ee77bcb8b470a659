#pragma once

#include "frontalis/runner/runner.hpp"
#include "frontalis/ros/shading.hpp"

#include <frontalis/SimulationState.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

namespace frontalis
{

/// Rest positions of the skin's vertices in the face frame [m].
std::vector<std::array<float, 3>> rest_in_face(const Model& model);

/// True where every vertex, normal and landmark of the skin is finite and their numbers are the model's.
bool is_publishable(const SkinState& skin, const Model& model);

/// Triangles of the skin with its rest positions, in the face frame [m].
shape_msgs::Mesh to_mesh(const Model& model);

/// Triangle list in the face frame, shaded; fills points and colours only, three of each a triangle.
void to_marker(const Model& model, const SkinShading& shading, const SkinState& skin, visualization_msgs::Marker& out);

/// Distance of each vertex from `rest` [m].
std::vector<float> distances(const SkinState& skin, const std::vector<std::array<float, 3>>& rest);

/// Points in vertex order with fields x y z normal_x normal_y normal_z intensity, all float32. Fills all but the
/// header.
void to_point_cloud(const SkinState& skin, const std::vector<float>& intensity, sensor_msgs::PointCloud2& out);

/// One pose a landmark, in the model's order, with the face frame's axes. Fills all but the header.
void to_poses(const SkinState& skin, geometry_msgs::PoseArray& out);

/// One transform a landmark, from `face_frame` to <face_frame>/<landmark>.
void to_transforms(const Model& model, const SkinState& skin, const std::string& face_frame, const ros::Time& stamp,
                   std::vector<geometry_msgs::TransformStamped>& out);

/// Rotation and translation of a transform. Throws Error where its quaternion does not have length 1, to within 1e-3.
RigidTransform to_motion(const geometry_msgs::Transform& transform);

/// Fills all but the header, `paused` and `backend`.
void to_state(const Model& model, const Frame& frame, SimulationState& out);

}  // namespace frontalis
