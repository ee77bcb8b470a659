// Gaps and slits that are thinner than voxels.

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

namespace
{

using namespace frontalis;

SceneConstraint held(const std::string& surface)
{
  SceneConstraint out;
  out.name = "hold_" + surface;
  out.surfaces = { surface };
  return out;
}

/// Two blocks of 12 x 12 mm, one above the other, `gap` [m] apart, held at their far sides. The gap lies within voxels.
Scene two_blocks(double gap, const std::string& gaps, double height = 7.3e-3)
{
  Scene scene = plain_scene(3e-3);
  scene.accuracy.gaps = gaps;
  scene.accuracy.fill_min = 0.02;
  const double z = height + gap;
  scene.surfaces = { box_surface("lower", { 6e-3, 6e-3, 0.5 * height }, { 12e-3, 12e-3, height }, 1e-3),
                     box_surface("upper", { 6e-3, 6e-3, z + 5e-3 }, { 12e-3, 12e-3, 10e-3 }, 1e-3),
                     box_surface("floor", { 6e-3, 6e-3, -1e-3 }, { 20e-3, 20e-3, 2e-3 }),
                     box_surface("roof", { 6e-3, 6e-3, z + 11e-3 }, { 20e-3, 20e-3, 2e-3 }) };
  scene.volumes = { volume_inside("below", { "lower" }, "fat", true),
                    volume_inside("above", { "upper" }, "muscle", true) };
  scene.constraints = { held("floor"), held("roof") };
  return scene;
}

/// A surface from a file at the height `z` [m], from beyond the blocks' side to x = `end`.
Surface slit_at(double z, double end)
{
  static const TemporaryFolder folder;
  const std::string file = folder / ("slit" + std::to_string(1e3 * z) + "_" + std::to_string(1e3 * end) + ".obj");
  TriangleMesh mesh;
  for (const double x : { -1e-3, end })
    for (const double y : { -1e-3, 13e-3 })
      mesh.vertices.push_back({ x, y, z });
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 } };
  write_obj(mesh, file, [](const auto&) { return true; });
  return file_surface("slit", file);
}

/// A block of 24 x 12 x 12 mm with a slit from its side x = 0 to x = `end` at the height `z` [m].
Scene slit_block(double z, double voxel = 3e-3, bool slit = true, double end = 12e-3)
{
  Scene scene = plain_scene(voxel);
  scene.surfaces = { box_surface("block", { 12e-3, 6e-3, 6e-3 }, { 24e-3, 12e-3, 12e-3 }, 1e-3), slit_at(z, end) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  if (slit)
    scene.volumes[0].slits = { "slit" };
  scene.skin.surface = "block";
  return scene;
}

/// Tissue of 6 mm below a face of a block, bounded by its depth alone, with a slit.
TEST(Slits, MayCutTissueThatHasADepthAlone)
{
  Scene scene = slit_block(10e-3);
  scene.volumes[0].inside.clear();
  scene.volumes[0].within = "block";
  scene.volumes[0].depth_max = 6e-3;
  EXPECT_GT(bake(scene).joints.size(), 0u);
}

/// Number of the body of each node. Nodes of the same voxel and joined nodes are in the same body.
std::vector<std::size_t> bodies_of(const Model& model)
{
  std::vector<std::size_t> body(model.nodes.size());
  std::iota(body.begin(), body.end(), std::size_t{ 0 });
  for (bool changed = true; changed;)
  {
    changed = false;
    const auto unite = [&](std::int32_t a, std::int32_t b)
    {
      std::size_t &x = body[static_cast<std::size_t>(a)], &y = body[static_cast<std::size_t>(b)];
      changed = changed || x != y;
      x = y = std::min(x, y);
    };
    for (const auto& corners : model.voxel_nodes)
      for (const std::int32_t n : corners)
        unite(corners[0], n);
    for (const Model::Joint& joint : model.joints)
      unite(joint.node, joint.master);
  }
  return body;
}

TEST(Gaps, ThinGapKeepsBlocksApart)
{
  for (const double gap : { 0.05e-3, 0.5e-3, 0.8e-3, 2e-3, 4e-3 })
  {
    const Model glued = bake(two_blocks(gap, "glued")), parted = bake(two_blocks(gap, "parted"));
    const auto bodies = bodies_of(parted);
    EXPECT_EQ(std::set<std::size_t>(bodies.begin(), bodies.end()).size(), 2u) << gap;
    // the amount of tissue does not change, and no voxel has tissue of both blocks
    for (const char* const name : { "fat", "muscle" })
      EXPECT_NEAR(tissue_volume(parted, name) / tissue_volume(glued, name), 1, 1e-5) << gap;
    for (std::size_t e = 0; e < parted.voxels.size(); ++e)
      EXPECT_EQ(parted.mixture_begin[e + 1] - parted.mixture_begin[e], 1) << gap;
    EXPECT_EQ(parted.rigid.size(), glued.rigid.size()) << gap;
  }
}

TEST(Gaps, SliversOfTheOtherSideJoinNothing)
{
  // the upper block reaches into the voxels of the lower one by less than fill_min
  for (const double sliver : { 0.02e-3, 0.04e-3, 0.06e-3 })
  {
    const auto bodies = bodies_of(bake(two_blocks(0.8e-3, "parted", 8.2e-3 - sliver)));
    EXPECT_EQ(std::set<std::size_t>(bodies.begin(), bodies.end()).size(), 2u) << sliver;
  }
  // a voxel has a tenth of its tissue from each block, enough for fill_min only together
  Scene scene = two_blocks(2.4e-3, "parted", 6.3e-3);
  scene.accuracy.fill_min = 0.15;
  const auto bodies = bodies_of(bake(scene));
  EXPECT_EQ(std::set<std::size_t>(bodies.begin(), bodies.end()).size(), 2u);
}

TEST(Gaps, BoneHoldsTheTissueThatItTouches)
{
  // the blocks are a gum of 1.5 mm on bone, and a lip over the gum
  const Model model = bake(two_blocks(0.5e-3, "parted", 1.5e-3));
  std::vector<bool> gum(model.nodes.size(), false);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (const std::int32_t n : model.voxel_nodes[e])
      if (model
              .materials[static_cast<std::size_t>(
                  model.mixture_material[static_cast<std::size_t>(model.mixture_begin[e])])]
              .name == "fat")
        gum[static_cast<std::size_t>(n)] = true;
  std::size_t held = 0;
  for (const RigidNode& node : model.rigid)
    if (model.constraints[static_cast<std::size_t>(node.constraint)] == "hold_floor")
    {
      EXPECT_TRUE(gum[static_cast<std::size_t>(node.node)]);
      ++held;
    }
  EXPECT_EQ(held, 25u);
}

TEST(Gaps, NodesAreAttachedToTissueOfTheirOwnSide)
{
  // the gum is 4.6 mm thick, one and a half voxels, so that the nearest free nodes above are those of the lip
  for (const double gap : { 0.05e-3, 0.5e-3, 2e-3 })
  {
    Scene scene = two_blocks(gap, "parted", 4.6e-3);
    scene.accuracy.boundary = "true";
    const Model model = bake(scene);
    ASSERT_FALSE(model.attached.empty()) << gap;
    const auto bodies = bodies_of(model);
    EXPECT_EQ(std::set<std::size_t>(bodies.begin(), bodies.end()).size(), 2u) << gap;
    for (const AttachedNode& node : model.attached)
      EXPECT_EQ(bodies[static_cast<std::size_t>(node.node)], bodies[static_cast<std::size_t>(node.master)]) << gap;
  }
}

TEST(Gaps, NodesBesideASlitAreAttachedToTheirOwnSide)
{
  // the slit begins at the bone, x = 0, and ends at x = 12 mm
  for (const double z : { 7e-3, 6e-3 })
  {
    Scene scene = slit_block(z);
    scene.accuracy.boundary = "true";
    scene.surfaces.push_back(box_surface("bone", { -1e-3, 6e-3, 6e-3 }, { 3e-3, 40e-3, 40e-3 }));
    scene.constraints = { held("bone") };
    const Model model = bake(scene);
    ASSERT_FALSE(model.attached.empty());
    // the side of a node is that of its voxels' tissue, since no voxel at the slit has tissue on both sides
    std::vector<double> side(model.nodes.size(), 0);
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      for (const std::int32_t n : model.voxel_nodes[e])
      {
        Vector3 mean{};
        for (const std::int32_t corner : model.voxel_nodes[e])
          for (std::size_t a = 0; a < 3; ++a)
            mean[a] += rest_position(model, static_cast<std::size_t>(corner))[a] / 8;
        for (std::size_t a = 0; a < 3; ++a)
          mean[a] += model.tissue_centre.empty() ? 0 : 0.5 * model.spacing[a] * double(model.tissue_centre[e][a]);
        side[static_cast<std::size_t>(n)] += transformed(model.to_scene, mean)[2] - z;
      }
    for (const AttachedNode& node : model.attached)
      EXPECT_GT(side[static_cast<std::size_t>(node.node)] * side[static_cast<std::size_t>(node.master)], 0);
  }
}

TEST(Gaps, SlitDoublesEachNodeOnItOnce)
{
  // the first slit passes through voxels, the second along a plane of the grid; both end at a plane of the grid
  for (const double z : { 7e-3, 6e-3 })
  {
    const Model whole = bake(slit_block(z, 3e-3, false)), cut = bake(slit_block(z));
    const bool in_plane = z == 6e-3;
    // 4 x 4 voxels are doubled if the slit passes through them
    EXPECT_EQ(cut.voxels.size(), whole.voxels.size() + (in_plane ? 0u : 16u)) << z;
    EXPECT_NEAR(tissue_volume(cut) / tissue_volume(whole), 1, 1e-6) << z;
    // joints count as one node; 4 x 5 nodes per layer are not at the slit's end
    EXPECT_EQ(cut.nodes.size() - cut.joints.size(), whole.nodes.size() + (in_plane ? 20u : 40u)) << z;
    const auto bodies = bodies_of(cut);
    EXPECT_EQ(std::set<std::size_t>(bodies.begin(), bodies.end()).size(), 1u) << z;
    for (const Model::Joint& joint : cut.joints)
      EXPECT_EQ(rest_position(cut, static_cast<std::size_t>(joint.node)),
                rest_position(cut, static_cast<std::size_t>(joint.master)));
  }
}

/// The least and the greatest x, over the rows of nodes along a slit, at which its sides come together [m]. A slit
/// through voxels parts the nodes below and above it.
std::set<double> ends_of(const Model& model)
{
  std::vector<std::size_t> node(model.nodes.size());
  std::iota(node.begin(), node.end(), std::size_t{ 0 });
  for (const Model::Joint& joint : model.joints)
    node[static_cast<std::size_t>(joint.node)] = static_cast<std::size_t>(joint.master);
  std::map<std::array<long, 3>, std::set<std::size_t>> at;
  for (std::size_t n = 0; n < node.size(); ++n)
  {
    const Vector3 p = transformed(model.to_scene, rest_position(model, n));
    at[{ std::lround(1e7 * p[0]), std::lround(1e7 * p[1]), std::lround(1e7 * p[2]) }].insert(node[n]);
  }
  std::map<std::pair<long, long>, long> parted_to;
  for (const auto& [place, nodes] : at)
    if (nodes.size() > 1)
    {
      long& to = parted_to[{ place[1], place[2] }];
      to = std::max(to, place[0]);
    }
  std::set<double> ends;
  for (const auto& row : parted_to)
    ends.insert(1e-7 * static_cast<double>(row.second) + model.spacing[0]);
  return ends;
}

TEST(Gaps, SlitsEndWithinHalfAVoxel)
{
  // the grid begins at the block's side, which is moved by a third of a voxel; slits pass through voxels or between
  // them
  for (const double voxel : { 3e-3, 2e-3, 1e-3 })
    for (const double shift : { 0.0, voxel / 3 })
      for (const double z : { 7.3e-3, 6e-3 })
        for (const double filled : { 0.2, 0.4, 0.6, 0.8 })
        {
          const double end = 12e-3 + filled * voxel;
          Scene scene = slit_block(z, voxel, true, end);
          scene.surfaces[0] = box_surface("block", { 12e-3 - shift / 2, 6e-3, 6e-3 }, { 24e-3 + shift, 12e-3, 12e-3 });
          const std::set<double> ends = ends_of(bake(scene));
          SCOPED_TRACE(std::to_string(1e3 * voxel) + " mm, shifted by " + std::to_string(1e3 * shift) + ", height " +
                       std::to_string(1e3 * z) + ", end " + std::to_string(1e3 * end));
          ASSERT_FALSE(ends.empty());
          EXPECT_NEAR(*ends.begin(), end, 0.5 * voxel);
          EXPECT_NEAR(*ends.rbegin(), end, 0.5 * voxel);
        }
}

TEST(Gaps, TissueThatASlitDoesNotReachStaysWhole)
{
  // the block ends 0.9 mm beyond the slit's last voxel, less than half a voxel beyond the slit
  for (const double z : { 7.3e-3, 6e-3 })
  {
    Scene scene = slit_block(z, 3e-3, true, 11.8e-3);
    scene.surfaces[0] = box_surface("block", { 6.45e-3, 6e-3, 6e-3 }, { 12.9e-3, 12e-3, 12e-3 });
    const std::set<double> ends = ends_of(bake(scene));
    ASSERT_EQ(ends.size(), 1u) << z;
    EXPECT_NEAR(*ends.begin(), 12e-3, 1e-6) << z;
  }
}

TEST(Gaps, PointsFollowTheirOwnSide)
{
  const double z = 7.3e-3;
  const Model cut = bake(slit_block(z));
  // each vertex beside the slit must be bound to a voxel of its own side
  std::vector<double> side(cut.voxels.size());
  std::size_t beside = 0;
  for (std::size_t v = 0; v < cut.skin.vertices.size(); ++v)
  {
    const Vector3 p = transformed(cut.to_scene, cut.skin.vertices[v]);
    if (p[0] > 11e-3 || std::abs(p[2] - z) > 2.9e-3)
      continue;
    double& of_voxel = side[static_cast<std::size_t>(cut.skin_binding.voxel[v])];
    const double of_point = p[2] > z ? 1 : -1;
    EXPECT_TRUE(of_voxel == 0 || of_voxel == of_point) << p[0] << " " << p[1] << " " << p[2];
    of_voxel = of_point;
    ++beside;
  }
  EXPECT_GT(beside, 20u);
}

// As in lips whose fissure is not quite where they meet: the slit cuts a sliver off one of the blocks.
TEST(Gaps, PointsFollowTheirOwnSideWhereASlitMissesTheGap)
{
  for (const double beside : { -0.2e-3, -0.1e-3, 0.0, 0.2e-3, 0.3e-3 })
    for (const char* const name : { "lower", "upper" })
    {
      Scene scene = two_blocks(0.1e-3, "glued");
      scene.surfaces.push_back(slit_at(7.3e-3 + beside, 13e-3));
      for (auto& volume : scene.volumes)
        volume.slits = { "slit" };
      scene.skin.surface = name;
      const Model model = bake(scene);
      const auto bodies = bodies_of(model);
      std::set<std::size_t> carrying;
      for (std::size_t v = 0; v < model.skin.vertices.size(); ++v)
      {
        const Vector3 p = transformed(model.to_scene, model.skin.vertices[v]);
        if (std::min({ p[0], p[1], 12e-3 - p[0], 12e-3 - p[1] }) < 0.5e-3)
          continue;  // at the sides the depth does not lead out of the sliver
        const auto voxel = static_cast<std::size_t>(model.skin_binding.voxel[v]);
        carrying.insert(bodies[static_cast<std::size_t>(model.voxel_nodes[voxel][0])]);
      }
      EXPECT_EQ(carrying.size(), 1U) << name << ' ' << beside;
    }
}

TEST(Gaps, WithoutAGapNothingChanges)
{
  Scene scene = slit_block(7e-3, 2e-3, false);
  scene.surfaces.push_back(box_surface("floor", { 12e-3, 6e-3, -1e-3 }, { 60e-3, 60e-3, 2e-3 }));
  scene.constraints = { held("floor") };
  const Model glued = bake(scene);
  scene.accuracy.gaps = "parted";
  Model parted = bake(scene);
  parted.scene_hash = glued.scene_hash;
  const TemporaryFolder folder;
  const std::string file = folder / "gaps.vtkhdf";
  const auto bytes = [&](const Model& model)
  {
    write_model(model, file);
    return text_of(file);
  };
  EXPECT_EQ(bytes(glued), bytes(parted));
  // a model with flaps is read as it was written
  const Model cut = bake(slit_block(7e-3));
  write_model(cut, file);
  const Model read = read_model(file);
  ASSERT_EQ(read.flaps.size(), 1u);
  EXPECT_EQ(read.flaps[0].first, cut.flaps[0].first);
  EXPECT_EQ(read.joints.size(), cut.joints.size());
  EXPECT_EQ(read.voxel_nodes, cut.voxel_nodes);
}

}  // namespace
