#include "frontalis/error.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "frontalis/ros/conversions.hpp"
#include "frontalis/ros/muscle_lines.hpp"
#include "frontalis/ros/skin_muscles.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include "ros/coloured_triangles.hpp"
#include "ros/marker_meshes.hpp"
#include "ros/small_model.hpp"

#include <gtest/gtest.h>
#include <tf2/LinearMath/Matrix3x3.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace frontalis
{
namespace
{

/// The skin at rest in the face frame, lifted by `lift` [m].
SkinState lifted(const Model& model, float lift)
{
  SkinState skin;
  skin.vertices = rest_in_face(model).vertices;
  for (auto& vertex : skin.vertices)
    vertex[2] += lift;
  skin.normals.assign(skin.vertices.size(), { { 0, 0, 1 } });
  skin.landmarks = { skin.vertices[0] };
  return skin;
}

float value(const sensor_msgs::PointCloud2& cloud, std::size_t point, std::size_t field)
{
  float out = 0;
  std::memcpy(&out, cloud.data.data() + point * cloud.point_step + cloud.fields.at(field).offset, sizeof out);
  return out;
}

TEST(Conversions, RestIsInTheFaceFrame)
{
  const auto rest = rest_in_face(small_model()).vertices;
  ASSERT_EQ(rest.size(), 4u);
  EXPECT_NEAR(rest[1][0], 1, 1e-6);
  EXPECT_NEAR(rest[1][1], 0.01, 1e-6);
  EXPECT_NEAR(rest[3][0], 0.99, 1e-6);
}

TEST(Conversions, MeshKeepsTheOrderOfVerticesAndCorners)
{
  const auto mesh = to_mesh(small_model());
  ASSERT_EQ(mesh.vertices.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1].vertex_indices[1], 2u);
  EXPECT_NEAR(mesh.vertices[2].x, 0.99, 1e-6);
  EXPECT_NEAR(mesh.vertices[2].y, 0.01, 1e-6);
}

TEST(Conversions, MarkerHasThreePointsAndColoursATriangle)
{
  const Model model = small_model();
  const SkinShading shading(model.skin, SkinColours(model.skin.vertices.size(), { { 0.9F, 0.7F, 0.6F } }));
  visualization_msgs::Marker marker;
  SkinColours colours;
  shading.colours(lifted(model, 0.002f), {}, colours);
  to_marker(model, colours, lifted(model, 0.002f), marker);
  EXPECT_EQ(marker.type, visualization_msgs::Marker::TRIANGLE_LIST);
  ASSERT_EQ(marker.points.size(), 6u);
  ASSERT_EQ(marker.colors.size(), 6u);
  EXPECT_NEAR(marker.points[4].x, 0.99, 1e-6);
  EXPECT_NEAR(marker.points[4].z, 0.012, 1e-6);
  EXPECT_EQ(marker.scale.x, 1);
  EXPECT_EQ(marker.pose.orientation.w, 1);
  for (const auto& colour : marker.colors)
  {
    EXPECT_EQ(colour.a, 1);
    EXPECT_GT(colour.r, 0);
    EXPECT_LE(colour.r, 1);
  }
}

TEST(Conversions, PointCloudHasPositionNormalAndDisplacement)
{
  const Model model = small_model();
  sensor_msgs::PointCloud2 cloud;
  const SkinState skin = lifted(model, 0.002f);
  to_point_cloud(skin, distances(skin, rest_in_face(model).vertices), SkinColours(4, { { 1, 0.2f, 0 } }), cloud);
  EXPECT_EQ(cloud.width, 4u);
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_EQ(cloud.data.size(), cloud.row_step);
  const char* const names[] = { "x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "rgb" };
  ASSERT_EQ(cloud.fields.size(), 8u);
  for (std::size_t field = 0; field < 8; ++field)
    EXPECT_EQ(cloud.fields[field].name, names[field]);
  EXPECT_NEAR(value(cloud, 1, 0), 1, 1e-6);
  EXPECT_NEAR(value(cloud, 1, 2), 0.012, 1e-6);
  EXPECT_EQ(value(cloud, 1, 5), 1);
  EXPECT_NEAR(value(cloud, 1, 6), 0.002, 1e-6);
  std::uint32_t rgb = 0;
  std::memcpy(&rgb, cloud.data.data() + cloud.point_step + cloud.fields[7].offset, sizeof rgb);
  EXPECT_EQ(rgb, 0xff3300u);
}

TEST(Conversions, LandmarksBecomePosesAndFrames)
{
  const Model model = small_model();
  const auto vertices = landmark_vertices(model);
  ASSERT_EQ(vertices, std::vector<std::size_t>{ 0 });
  SkinState skin = lifted(model, 0.002f);
  skin.normals[0] = { { 0.6f, 0.64f, 0.48f } };
  geometry_msgs::PoseArray poses;
  to_poses(skin, vertices, poses);
  ASSERT_EQ(poses.poses.size(), 1u);
  EXPECT_NEAR(poses.poses[0].position.z, 0.012, 1e-6);
  // the pose's x is along the normal, y is level, and z points upwards
  const auto& q = poses.poses[0].orientation;
  const tf2::Matrix3x3 axes(tf2::Quaternion(q.x, q.y, q.z, q.w));
  EXPECT_NEAR(axes.getColumn(0).x(), 0.6, 1e-6);
  EXPECT_NEAR(axes.getColumn(0).y(), 0.64, 1e-6);
  EXPECT_NEAR(axes.getColumn(0).z(), 0.48, 1e-6);
  EXPECT_NEAR(axes.getColumn(1).z(), 0, 1e-6);
  EXPECT_GT(axes.getColumn(2).z(), 0.8);

  std::vector<geometry_msgs::TransformStamped> transforms;
  Frame frame;
  frame.skin = lifted(model, 0.002f);
  to_transforms(model, frame, poses, "face_7", ros::Time(5), transforms);
  ASSERT_EQ(transforms.size(), 1u);
  EXPECT_EQ(transforms[0].header.frame_id, "face_7");
  EXPECT_EQ(transforms[0].child_frame_id, "face_7/brow");
  EXPECT_EQ(transforms[0].header.stamp, ros::Time(5));
  EXPECT_NEAR(transforms[0].transform.translation.x, 1, 1e-6);
  EXPECT_EQ(transforms[0].transform.rotation, q);
}

TEST(Conversions, BonesBecomeFramesAndEyesAreShownInTheirs)
{
  Model model = small_model();
  model.bones = { "jaw", "eye_left" };
  model.expressions.push_back({ "open", {}, { { 0, {}, {}, { { -0.08, 0, -0.05 } } } } });
  ConstraintSurface eye;
  eye.bone = 1;
  eye.field = SampledField();
  eye.field.origin = inverse(model.to_face)(std::array<double, 3>{ { 0.01, 0.03, -0.01 } });
  eye.field.radius = 0.012;
  model.constraint_surfaces.push_back(eye);
  Frame frame;
  frame.skin = lifted(model, 0);
  // the eye looks to the subject's left: a quarter turn about its centre
  RigidTransform looks;
  looks.rotation = { { 0, -1, 0, 1, 0, 0, 0, 0, 1 } };
  looks.translation = { { 0.01 + 0.03, 0.03 - 0.01, 0 } };
  frame.bones = { { {}, RigidTransform() }, { {}, looks } };
  geometry_msgs::PoseArray poses;
  to_poses(frame.skin, landmark_vertices(model), poses);
  std::vector<geometry_msgs::TransformStamped> transforms;
  to_transforms(model, frame, poses, "face_7", ros::Time(5), transforms);
  ASSERT_EQ(transforms.size(), 3u);
  EXPECT_EQ(transforms[1].child_frame_id, "face_7/bone/jaw");
  EXPECT_NEAR(transforms[1].transform.translation.x, -0.08, 1e-9);
  EXPECT_NEAR(transforms[1].transform.rotation.w, 1, 1e-9);
  EXPECT_EQ(transforms[2].child_frame_id, "face_7/bone/eye_left");
  EXPECT_NEAR(transforms[2].transform.translation.x, 0.01, 1e-9);
  EXPECT_NEAR(transforms[2].transform.translation.y, 0.03, 1e-9);
  EXPECT_NEAR(transforms[2].transform.rotation.z, std::sqrt(0.5), 1e-9);

  // In the bone's frame, the iris is a cap on the ball around the origin, and the eye looks along x.
  const auto markers = to_eyeballs(model, "face_7").markers;
  ASSERT_EQ(markers.size(), 2u);
  for (const auto& marker : markers)
  {
    EXPECT_EQ(marker.ns, "eye_left");
    EXPECT_EQ(marker.header.frame_id, transforms[2].child_frame_id);
    EXPECT_TRUE(marker.header.stamp.isZero());
    EXPECT_TRUE(marker.frame_locked);
  }
  EXPECT_NE(markers[0].id, markers[1].id);
  EXPECT_EQ(markers[0].pose.position, geometry_msgs::Point());
  EXPECT_NEAR(markers[0].scale.y, 0.024, 1e-9);
  ASSERT_FALSE(markers[1].points.empty());
  EXPECT_EQ(markers[1].colors.size(), markers[1].points.size());
  for (const auto& point : markers[1].points)
  {
    EXPECT_GT(std::hypot(point.x, point.y, point.z), 0.012);
    EXPECT_LT(std::hypot(point.y, point.z), 0.0065);
    EXPECT_LT(point.x, 0.014);
    EXPECT_GT(point.x, 0);
  }
}

TEST(Conversions, PaintedTeethComeBackFromTheirMarker)
{
  Model model = small_model();
  model.landmarks.push_back("mouth_corner_left");
  model.landmark_positions.push_back({ { 0, 0.03, 0 } });
  Contact teeth;
  teeth.name = "teeth_upper";
  teeth.points = { { { 0, 0, 0 } } };
  teeth.centre = { { 0.01, 0, 0 } };
  // a wall of 60 x 40 mm that faces forwards
  constexpr std::int32_t columns = 31, rows = 21;
  const RigidTransform from_face = inverse(model.to_face);
  for (std::int32_t r = 0; r < rows; ++r)
    for (std::int32_t c = 0; c < columns; ++c)
    {
      teeth.shape.vertices.push_back(from_face(std::array<double, 3>{ { -0.01, 2e-3 * c - 0.03, 2e-3 * r - 0.02 } }));
      const std::int32_t corner = r * columns + c;
      if (c + 1 == columns || r + 1 == rows)
        continue;
      teeth.shape.triangles.push_back({ corner, corner + 1, corner + columns + 1 });
      teeth.shape.triangles.push_back({ corner, corner + columns + 1, corner + columns });
    }
  model.contacts.push_back(teeth);
  const RenderMesh painted = body_at_rest(model, body_shapes(model)[0]);
  const RenderMesh seen = mesh_of_body(to_bodies(model, "face_7").markers.at(0));
  ASSERT_EQ(seen.triangles.size(), painted.triangles.size());
  for (std::size_t t = 0; t < seen.triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      const auto s = static_cast<std::size_t>(seen.triangles[t][corner]);
      const auto p = static_cast<std::size_t>(painted.triangles[t][corner]);
      ASSERT_EQ(seen.labels[s], painted.labels[p]);
      for (std::size_t channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(seen.colours[s][channel], painted.colours[p][channel], 0.05F) << t;
    }
  // the teeth end at their edges, a few millimetres below the corners of the mouth
  for (const auto& p : painted.vertices)
    EXPECT_GT(p[2], -0.01);
}

TEST(Conversions, LandmarksOnSkinThatFacesUpHaveAxesToo)
{
  const Model model = small_model();
  geometry_msgs::PoseArray poses;
  to_poses(lifted(model, 0), landmark_vertices(model), poses);
  const auto& q = poses.poses.at(0).orientation;
  const tf2::Matrix3x3 axes(tf2::Quaternion(q.x, q.y, q.z, q.w));
  EXPECT_NEAR(axes.getColumn(0).z(), 1, 1e-6);
  EXPECT_NEAR(axes.getColumn(2).x(), -1, 1e-6);
}

TEST(Conversions, StandardLandmarksAreInTheirOrderAndComplete)
{
  Model model = small_model();
  for (int number = 68; number >= 1; --number)
    model.landmarks.push_back("ibug_" + std::to_string(number));
  const auto found = standard_landmarks(model);
  ASSERT_EQ(found.size(), 68u);
  EXPECT_EQ(model.landmarks[found[0]], "ibug_1");
  EXPECT_EQ(model.landmarks[found[67]], "ibug_68");
  model.landmarks[found[30]] = "nose";
  EXPECT_TRUE(standard_landmarks(model).empty());
}

TEST(Conversions, TrianglesOfTheDisplayAreThoseOfTheCloudAndTheTopology)
{
  const Model model = small_model();
  const SkinColours colours{ { { 1, 0, 0 } }, { { 0, 1, 0 } }, { { 0, 0, 1 } }, { { 1, 1, 1 } } };
  sensor_msgs::PointCloud2 cloud;
  to_point_cloud(lifted(model, 0.002F), { 0, 0, 0, 0 }, colours, cloud);
  const ColouredTriangles skin = skin_of(cloud, to_mesh(model));
  ASSERT_EQ(skin.vertices.size(), 4u);
  EXPECT_NEAR(skin.vertices[1].position[1], 0.01, 1e-6);
  EXPECT_NEAR(skin.vertices[1].position[2], 0.012, 1e-6);
  EXPECT_EQ(skin.vertices[1].colour, (std::array<std::uint8_t, 4>{ { 0, 255, 0, 255 } }));
  EXPECT_EQ(skin.corners, (std::vector<std::uint32_t>{ 0, 1, 2, 0, 2, 3 }));

  shape_msgs::Mesh other = to_mesh(model);
  other.triangles[1].vertex_indices[0] = 4;
  EXPECT_THROW(skin_of(cloud, other), Error);
  sensor_msgs::PointCloud2 bad = cloud;
  bad.data.resize(bad.data.size() - 1);
  EXPECT_THROW(vertices_of(bad), Error);
  bad = cloud;
  bad.fields.back().name = "grey";
  EXPECT_THROW(vertices_of(bad), Error);
  to_point_cloud(lifted(model, std::numeric_limits<float>::quiet_NaN()), { 0, 0, 0, 0 }, colours, bad);
  EXPECT_THROW(vertices_of(bad), Error);
}

TEST(Conversions, MuscleLinesMoveWithTheTissue)
{
  Model model = small_model();
  model.fibre_begin = { 0, 1 };
  model.fibre_muscle = { 1 };
  model.fibre_weight = { 1 };
  model.fibre_direction = { { { 0, 0, 1 } } };
  const MuscleLines lines(model);
  visualization_msgs::MarkerArray out;
  lines.fill(model, std::vector<std::array<double, 3>>(8, { { 0, 0, 0.001 } }), { 0, 1 }, out);
  ASSERT_EQ(out.markers.size(), 2u);
  EXPECT_EQ(out.markers[1].ns, "knitter");
  EXPECT_TRUE(out.markers[0].points.empty());
  ASSERT_EQ(out.markers[1].points.size(), 2u);
  EXPECT_NEAR(out.markers[1].points[0].z, 0.001, 1e-12);
  EXPECT_NEAR(out.markers[1].points[1].z, 0.011, 1e-12);
  // a voxel of a flap rests lower than its index says
  model.voxels[0][2] = 5;
  model.flaps = { { 4, 5 } };
  lines.fill(model, std::vector<std::array<double, 3>>(8, { { 0, 0, 0.001 } }), { 0, 1 }, out);
  ASSERT_EQ(out.markers[1].points.size(), 2u);
  EXPECT_NEAR(out.markers[1].points[0].z, 0.001, 1e-12);
  // full activation is red, and zero activation is blue
  EXPECT_GT(out.markers[1].color.r, out.markers[1].color.b);
  EXPECT_GT(out.markers[0].color.b, out.markers[0].color.r);
}

TEST(Conversions, StateNamesMusclesAndLandmarks)
{
  Frame frame;
  frame.time = 1.5;
  frame.steps = 300;
  frame.activation = { 0.25f, 0.5f };
  frame.failed = true;
  frame.failure = "a voxel turned inside out";
  frame.monitor.kinetic = 2e-6;
  SimulationState state;
  to_state(small_model(), frame, state);
  EXPECT_EQ(state.time, 1.5);
  EXPECT_EQ(state.steps, 300u);
  ASSERT_EQ(state.name.size(), 2u);
  EXPECT_EQ(state.name[1], "knitter");
  ASSERT_EQ(state.activation.size(), 2u);
  EXPECT_EQ(state.activation[0], 0.25);
  EXPECT_EQ(state.landmark, std::vector<std::string>{ "brow" });
  EXPECT_TRUE(state.failed);
  EXPECT_EQ(state.message, "a voxel turned inside out");
  EXPECT_EQ(state.kinetic_energy, 2e-6);
  EXPECT_EQ(state.voxels, 1u);
  EXPECT_EQ(state.nodes, 8u);
  EXPECT_EQ(state.skin_vertices, 4u);
}

TEST(Conversions, SkinThatIsNotFiniteOrNotWholeIsNotPublishable)
{
  const Model model = small_model();
  EXPECT_TRUE(is_publishable(lifted(model, 0), model));
  const float bad[] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity() };
  for (const float number : bad)
  {
    SkinState skin = lifted(model, 0);
    skin.vertices[3][1] = number;
    EXPECT_FALSE(is_publishable(skin, model));
    skin = lifted(model, 0);
    skin.normals[0][2] = number;
    EXPECT_FALSE(is_publishable(skin, model));
    skin = lifted(model, 0);
    skin.landmarks[0][0] = number;
    EXPECT_FALSE(is_publishable(skin, model));
  }
  SkinState skin = lifted(model, 0);
  skin.normals.pop_back();
  EXPECT_FALSE(is_publishable(skin, model));
}

TEST(SkinMuscles, MixesTheActivationsOfTheMusclesBelow)
{
  Model model = small_model();
  model.fibre_begin = { 0, 2 };
  model.fibre_muscle = { 0, 1 };
  model.fibre_weight = { 0.6F, 0.2F };
  const auto found = SkinMuscles(model).activation({ 1, 0.5F });
  ASSERT_EQ(found.size(), 4U);
  EXPECT_NEAR(found[0], 0.875, 1e-6) << "three quarters of the one muscle and one of the other";
  EXPECT_EQ(found[2], 0) << "a vertex on the far border has no voxel below it";
}

TEST(SkinMuscles, CountBothVoxelsOfAPartedPlace)
{
  Model model = small_model();
  model.size = { { 1, 1, 3 } };
  model.voxels = { { { 0, 0, 0 } }, { { 0, 0, 2 } } };
  model.flaps = { { 2, 2 } };
  model.fibre_begin = { 0, 1, 2 };
  model.fibre_muscle = { 0, 1 };
  model.fibre_weight = { 0.6F, 0.2F };
  EXPECT_NEAR(SkinMuscles(model).activation({ 1, 0.5F })[0], 0.875, 1e-6);
}

}  // namespace
}  // namespace frontalis
