// Which fabric's surface the tactile renderer strokes.
#pragma once

#include <haptex/ClothMesh.h>

#include <optional>
#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/material/surface.h"
#include "haptex/tactile/surface.h"

namespace haptex::nodes {

/// The surface of the cloth's fabric, or, until the cloth gets another fabric, the one that
/// somebody asked for.
class SurfaceChoice {
 public:
  /// Begins with the fabric of a scene. That it has no surface is no error.
  /// @param scene_fabric path of its file; empty without a scene: then there is no surface yet
  /// @throws std::exception naming the file and what is wrong with the fabric or its surface
  explicit SurfaceChoice(const std::string& scene_fabric);

  /// Takes the fabric of cloth/mesh; does nothing if that is as before. Without a surface
  /// that can be stroked there is none from then on: another fabric's would be wrong.
  /// @returns whether it is another fabric
  bool receiveCloth(const haptex::ClothMesh& message);

  /// @param fabric name of a fabric in config/fabrics or the path of a fabric file
  /// @throws std::exception naming what is wrong with the fabric or its surface, or that it has
  ///   none; the surface is then as before
  void ask(const std::string& fabric);

  /// Null if there is none. Valid until the next call of a function that is not const.
  const tactile::Surface* surface() const { return surface_ ? &*surface_ : nullptr; }
  /// Why there is no surface; empty if there is one.
  const std::string& trouble() const { return trouble_; }
  /// Name of the fabric, and the path of its file or that it came in cloth/mesh; empty where it is
  /// not known.
  const std::string& fabric() const { return fabric_; }
  const std::string& path() const { return path_; }
  /// Where it comes from, for people.
  const char* origin() const { return asked_ ? "tactile/set_surface" : "the cloth"; }
  /// Its KES surface values.
  const std::optional<material::Surface>& values() const { return values_; }

 private:
  struct FabricOfFile {
    material::Fabric fabric;
    std::string path;
  };

  static FabricOfFile readFabric(const std::string& path);
  static std::string withoutSurface(const FabricOfFile& read);
  /// @throws std::exception what tactile::buildSurface() throws; nothing has changed then
  void use(const FabricOfFile& read);
  void useIfAny(const FabricOfFile& read);
  void useNone(const FabricOfFile& read, const std::string& why);

  std::vector<std::string> cloth_names_, cloth_files_;  // of its fabrics, as in cloth/mesh
  std::optional<tactile::Surface> surface_;
  std::optional<material::Surface> values_;
  std::string fabric_, path_;
  std::string trouble_;
  bool asked_ = false;
};

}  // namespace haptex::nodes
