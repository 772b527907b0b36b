// A deforming surface in an Ogre scene.
#pragma once

#include <OGRE/OgreHardwareVertexBuffer.h>
#include <OGRE/OgreMaterial.h>
#include <OGRE/OgreMesh.h>
#include <OGRE/OgreRenderOperation.h>

#include <cstdint>
#include <vector>

#include "haptex/nodes/rviz_plugin/cloth_surface.h"

namespace Ogre {
class Entity;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace haptex::nodes {

/// What is drawn of a surface.
struct SurfaceStyle {
  bool wireframe = false;    ///< edges of the triangles alone
  bool grain_lines = false;  ///< weft and warp, over the triangles
  bool transparent = false;  ///< the colours' opacity counts
};

/// Draws a ClothSurface: one buffer of positions and one of colours, which every state overwrites;
/// triangles, grain lines and attached particles are indices into them. Both sides are seen. The
/// mouse goes through it, to the handles behind. By the thread of the scene.
class SurfaceObject {
 public:
  /// @param parent the node to which this adds its own; outlives this, as the manager does
  SurfaceObject(Ogre::SceneManager& manager, Ogre::SceneNode& parent, const ClothSurface& surface);
  ~SurfaceObject();
  SurfaceObject(const SurfaceObject&) = delete;
  SurfaceObject& operator=(const SurfaceObject&) = delete;

  void setStyle(const SurfaceStyle& style);

  /// Overwrites the buffers. @param surface the one it was made of, or of as many vertices
  /// @param attached vertices that are marked
  void update(const ClothSurface& surface, const std::vector<std::uint32_t>& attached);
  /// Overwrites the colours alone. @param surface as for update()
  void recolour(const ClothSurface& surface);

 private:
  void makeBuffers(const ClothSurface& surface);
  void addPart(Ogre::RenderOperation::OperationType type, const std::vector<std::uint32_t>& indices,
               const Ogre::MaterialPtr& material, bool coloured);

  Ogre::SceneManager& manager_;
  Ogre::SceneNode* node_;
  Ogre::MeshPtr mesh_;
  Ogre::Entity* entity_ = nullptr;
  Ogre::MaterialPtr surface_material_, line_material_, point_material_;
  Ogre::HardwareVertexBufferSharedPtr positions_, colours_;
  std::vector<std::uint32_t> attached_;
};

}  // namespace haptex::nodes
