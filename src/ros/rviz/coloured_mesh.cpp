#include "ros/rviz/coloured_mesh.hpp"

#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreSceneManager.h>

#include <cstddef>

namespace frontalis
{

ColouredMesh::ColouredMesh(const ColouredTriangles& mesh, Ogre::SceneNode& parent)
    : node_(parent.createChildSceneNode())
{
  auto& buffers = Ogre::HardwareBufferManager::getSingleton();
  auto* const declaration = vertex_data_.vertexDeclaration;
  declaration->addElement(0, offsetof(ColouredVertex, position), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  declaration->addElement(0, offsetof(ColouredVertex, colour), Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  buffer_ = buffers.createVertexBuffer(sizeof(ColouredVertex), mesh.vertices.size(),
                                       Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY);
  vertex_data_.vertexCount = mesh.vertices.size();
  vertex_data_.vertexBufferBinding->setBinding(0, buffer_);
  index_data_.indexCount = mesh.corners.size();
  index_data_.indexBuffer = buffers.createIndexBuffer(Ogre::HardwareIndexBuffer::IT_32BIT, mesh.corners.size(),
                                                      Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  index_data_.indexBuffer->writeData(0, mesh.corners.size() * sizeof mesh.corners[0], mesh.corners.data(), true);
  mRenderOp.operationType = Ogre::RenderOperation::OT_TRIANGLE_LIST;
  mRenderOp.useIndexes = true;
  mRenderOp.vertexData = &vertex_data_;
  mRenderOp.indexData = &index_data_;

  const Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(getName(), Ogre::RGN_DEFAULT);
  material->setReceiveShadows(false);
  material->setLightingEnabled(false);
  material->setCullingMode(Ogre::CULL_NONE);
  setMaterial(material);
  set_vertices(mesh.vertices);
  node_->attachObject(this);
}

ColouredMesh::~ColouredMesh()
{
  node_->getCreator()->destroySceneNode(node_);
  Ogre::MaterialManager::getSingleton().remove(mMaterial);
}

void ColouredMesh::set_vertices(const std::vector<ColouredVertex>& vertices)
{
  Ogre::AxisAlignedBox box;
  for (const auto& [position, colour] : vertices)
    box.merge(Ogre::Vector3(position[0], position[1], position[2]));
  buffer_->writeData(0, vertices.size() * sizeof(ColouredVertex), vertices.data(), true);
  setBoundingBox(box);
  node_->needUpdate();
}

void ColouredMesh::place(const Ogre::Vector3& position, const Ogre::Quaternion& orientation)
{
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

Ogre::Real ColouredMesh::getSquaredViewDepth(const Ogre::Camera* camera) const
{
  return node_->getSquaredViewDepth(camera);
}

}  // namespace frontalis
