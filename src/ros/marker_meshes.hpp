#pragma once

#include "frontalis/render/renderer.hpp"

#include <visualization_msgs/Marker.h>

namespace frontalis
{

/// What the markers of ~eyes and ~bodies show (conversions.hpp), for pictures: an eyeball, an iris with its colours,
/// and the surface of a body, all in the marker's frame. Corners of a body's triangles at one place become one vertex,
/// so that it is drawn smooth.
RenderBall ball_of(const visualization_msgs::Marker& marker);
RenderMesh mesh_of_iris(const visualization_msgs::Marker& marker);
RenderMesh mesh_of_body(const visualization_msgs::Marker& marker);
RenderMesh moved(RenderMesh mesh, const RigidTransform& pose);

}  // namespace frontalis
