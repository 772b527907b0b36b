#include "haptex/nodes/rviz_plugin/surface_object.h"

#include <OGRE/OgreEntity.h>
#include <OGRE/OgreHardwareBufferManager.h>
#include <OGRE/OgreMaterialManager.h>
#include <OGRE/OgreMeshManager.h>
#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreSubEntity.h>
#include <OGRE/OgreSubMesh.h>
#include <OGRE/OgreTechnique.h>

#include <algorithm>
#include <atomic>
#include <string>

namespace haptex::nodes {
namespace {

constexpr char kGroup[] = "General";  // of resources
constexpr float kPointSize = 5.0F;    // pixels, of an attached particle
const Ogre::ColourValue kMarkColour(0.15F, 0.16F, 0.18F);
enum Part { kTriangles, kLines, kPoints };

std::string uniqueName(const std::string& what) {
  static std::atomic<unsigned> count{0};
  return "haptex " + what + " " + std::to_string(count++);
}

/// Unlit, both sides. Ogre draws by the scheme of that name when rviz looks for what the mouse is
/// on: then it writes nothing.
Ogre::MaterialPtr makeMaterial(const std::string& what) {
  const Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create(uniqueName(what), kGroup);
  material->setReceiveShadows(false);
  Ogre::Technique* technique = material->getTechnique(0);
  technique->setCullingMode(Ogre::CULL_NONE);
  technique->setLightingEnabled(false);
  for (const char* scheme : {"Pick", "Pick1", "Depth"}) {
    Ogre::Technique* unseen = material->createTechnique();
    unseen->setSchemeName(scheme);
    Ogre::Pass* pass = unseen->createPass();
    pass->setColourWriteEnabled(false);
    pass->setDepthWriteEnabled(false);
  }
  return material;
}

/// One colour for all, whatever the vertices have.
void setPlainColour(const Ogre::MaterialPtr& material) {
  Ogre::Pass* pass = material->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(true);
  pass->setAmbient(Ogre::ColourValue::Black);
  pass->setDiffuse(Ogre::ColourValue(0.0F, 0.0F, 0.0F, 1.0F));
  pass->setSelfIllumination(kMarkColour);
  pass->setPointSize(kPointSize);
  pass->setDepthBias(1.0F, 1.0F);  // in front of the triangles that it lies on
}

Ogre::HardwareIndexBufferSharedPtr indexBuffer(const std::vector<std::uint32_t>& indices) {
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, std::max<std::size_t>(1, indices.size()),
      Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  if (!indices.empty()) buffer->writeData(0, 4 * indices.size(), indices.data(), true);
  return buffer;
}

}  // namespace

SurfaceObject::SurfaceObject(Ogre::SceneManager& manager, Ogre::SceneNode& parent,
                             const ClothSurface& surface)
    : manager_(manager),
      node_(parent.createChildSceneNode()),
      surface_material_(makeMaterial("surface")),
      line_material_(makeMaterial("grain lines")),
      point_material_(makeMaterial("attached particles")) {
  setPlainColour(line_material_);
  setPlainColour(point_material_);
  makeBuffers(surface);
  using Operation = Ogre::RenderOperation;
  addPart(Operation::OT_TRIANGLE_LIST, surface.triangles(), surface_material_, true);
  addPart(Operation::OT_LINE_LIST, surface.grainLines(), line_material_, false);
  addPart(Operation::OT_POINT_LIST, {}, point_material_, false);
  mesh_->_setBounds(Ogre::AxisAlignedBox(-1.0F, -1.0F, -1.0F, 1.0F, 1.0F, 1.0F));
  mesh_->load();
  entity_ = manager_.createEntity(mesh_);
  entity_->setCastShadows(false);
  node_->attachObject(entity_);
  node_->setVisible(false);  // until there is a state
  setStyle({});
}

SurfaceObject::~SurfaceObject() {
  manager_.destroyEntity(entity_);
  manager_.destroySceneNode(node_);
  Ogre::MeshManager::getSingleton().remove(mesh_);
  for (const Ogre::MaterialPtr& material : {surface_material_, line_material_, point_material_}) {
    Ogre::MaterialManager::getSingleton().remove(material);
  }
}

void SurfaceObject::makeBuffers(const ClothSurface& surface) {
  mesh_ = Ogre::MeshManager::getSingleton().createManual(uniqueName("cloth"), kGroup);
  auto& buffers = Ogre::HardwareBufferManager::getSingleton();
  const auto usage = Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE;
  positions_ = buffers.createVertexBuffer(3 * sizeof(float), surface.vertexCount(), usage);
  colours_ = buffers.createVertexBuffer(sizeof(VertexColour), surface.vertexCount(), usage);
}

/// Each with vertex data of its own that share the buffers: marks do without the colours.
void SurfaceObject::addPart(Ogre::RenderOperation::OperationType type,
                            const std::vector<std::uint32_t>& indices,
                            const Ogre::MaterialPtr& material, bool coloured) {
  Ogre::SubMesh* part = mesh_->createSubMesh();
  part->useSharedVertices = false;
  part->operationType = type;
  part->vertexData = new Ogre::VertexData();  // the part's
  part->vertexData->vertexCount = positions_->getNumVertices();
  Ogre::VertexDeclaration* declaration = part->vertexData->vertexDeclaration;
  declaration->addElement(0, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  part->vertexData->vertexBufferBinding->setBinding(0, positions_);
  if (coloured) {
    declaration->addElement(1, 0, Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
    part->vertexData->vertexBufferBinding->setBinding(1, colours_);
  }
  part->indexData->indexBuffer = indexBuffer(indices);
  part->indexData->indexCount = indices.size();
  part->setMaterialName(material->getName(), kGroup);
}

void SurfaceObject::setStyle(const SurfaceStyle& style) {
  Ogre::Technique* technique = surface_material_->getTechnique(0);
  technique->getPass(0)->setPolygonMode(style.wireframe ? Ogre::PM_WIREFRAME : Ogre::PM_SOLID);
  technique->setSceneBlending(style.transparent ? Ogre::SBT_TRANSPARENT_ALPHA : Ogre::SBT_REPLACE);
  technique->setDepthWriteEnabled(!style.transparent);
  entity_->getSubEntity(kLines)->setVisible(style.grain_lines &&
                                            mesh_->getSubMesh(kLines)->indexData->indexCount > 0);
}

void SurfaceObject::recolour(const ClothSurface& surface) {
  colours_->writeData(0, colours_->getSizeInBytes(), surface.colours().data(), true);
}

void SurfaceObject::update(const ClothSurface& surface,
                           const std::vector<std::uint32_t>& attached) {
  positions_->writeData(0, positions_->getSizeInBytes(), surface.positions().data(), true);
  recolour(surface);
  if (attached != attached_) {
    attached_ = attached;
    Ogre::IndexData* points = mesh_->getSubMesh(kPoints)->indexData;
    points->indexBuffer = indexBuffer(attached_);
    points->indexCount = attached_.size();
  }
  entity_->getSubEntity(kPoints)->setVisible(!attached_.empty());
  const Ogre::Vector3 low(surface.low().x(), surface.low().y(), surface.low().z());
  const Ogre::Vector3 high(surface.high().x(), surface.high().y(), surface.high().z());
  mesh_->_setBounds(Ogre::AxisAlignedBox(low, high));
  node_->needUpdate();
  node_->setVisible(true, false);
  entity_->setVisible(true);
}

}  // namespace haptex::nodes
