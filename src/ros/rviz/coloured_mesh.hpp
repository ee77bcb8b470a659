#pragma once

#include "ros/coloured_triangles.hpp"

#include <OgreHardwareVertexBuffer.h>
#include <OgreSceneNode.h>
#include <OgreSimpleRenderable.h>

#include <vector>

namespace frontalis
{

/// Triangles of coloured vertices in a scene of Ogre. Light does not change their colours, and both sides are seen.
/// The graphics card keeps the triangles; vertices that are set again take 16 bytes each.
class ColouredMesh : public Ogre::SimpleRenderable
{
public:
  /// `mesh`: at least one triangle, finite vertices. Its own node is added to `parent`.
  ColouredMesh(const ColouredTriangles& mesh, Ogre::SceneNode& parent);
  ~ColouredMesh() override;
  ColouredMesh(const ColouredMesh&) = delete;
  ColouredMesh& operator=(const ColouredMesh&) = delete;

  /// Moves and colours the vertices, as many as at construction.
  void set_vertices(const std::vector<ColouredVertex>& vertices);
  void place(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);

  Ogre::Real getBoundingRadius() const override { return Ogre::Math::boundingRadiusFromAABB(mBox); }
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;

private:
  Ogre::SceneNode* node_;
  Ogre::VertexData vertex_data_;
  Ogre::IndexData index_data_;
  Ogre::HardwareVertexBufferSharedPtr buffer_;
};

}  // namespace frontalis
