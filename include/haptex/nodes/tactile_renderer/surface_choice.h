// Which fabrics' surfaces the tactile renderer strokes.
#pragma once

#include <haptex/ClothMesh.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/material/surface.h"
#include "haptex/tactile/surface.h"

namespace haptex::nodes {

/// The surfaces of the cloth's fabrics, or, until the cloth gets other fabrics, the one that
/// somebody asked for, everywhere.
class SurfaceChoice {
 public:
  /// Begins with the fabric of a scene; those of its regions come with cloth/mesh. That it has no
  /// surface is no error.
  /// @param scene_fabric path of its file; empty without a scene: then there is no surface yet
  /// @throws std::exception naming the file and what is wrong with the fabric or its surface
  explicit SurfaceChoice(const std::string& scene_fabric);

  /// Takes the fabrics of cloth/mesh; does nothing if those are as before. On one without a surface
  /// that can be stroked there is none from then on: another fabric's would be wrong.
  /// @returns whether they are other fabrics
  bool receiveCloth(const haptex::ClothMesh& message);

  /// @param fabric name of a fabric in config/fabrics or the path of a fabric file
  /// @throws std::exception naming what is wrong with the fabric or its surface, or that it has
  ///   none; the surfaces are then as before
  void ask(const std::string& fabric);

  /// Of one of the cloth's fabrics. Null if there is none. Valid until the next call of a function
  /// that is not const.
  const tactile::Surface* surface(std::size_t fabric = 0) const;
  /// Why there is no surface, of the first fabric without; empty if all have one.
  const std::string& trouble() const;
  /// Names of the fabrics, and the path of the first one's file or that it came in cloth/mesh;
  /// empty where it is not known.
  std::string fabric() const;
  const std::string& path() const { return choices_.front().path; }
  /// Where it comes from, for people.
  const char* origin() const { return asked_ ? "tactile/set_surface" : "the cloth"; }
  /// The first one's KES surface values.
  const std::optional<material::Surface>& values() const { return choices_.front().values; }

 private:
  struct FabricOfFile {
    material::Fabric fabric;
    std::string path;
  };
  struct Choice {
    std::optional<tactile::Surface> surface;
    std::optional<material::Surface> values;
    std::string fabric, path, trouble;
  };

  static FabricOfFile readFabric(const std::string& path);
  static std::string withoutSurface(const FabricOfFile& read);
  /// @throws std::exception what tactile::buildSurface() throws
  static Choice chosen(const FabricOfFile& read);
  static Choice none(const FabricOfFile& read, const std::string& why);
  static Choice chosenIfAny(const FabricOfFile& read);
  static Choice ofCloth(const haptex::ClothMesh& message, std::size_t index);

  std::vector<std::string> cloth_names_, cloth_files_;  // of its fabrics, as in cloth/mesh
  std::vector<Choice> choices_;  // at least one: of the cloth's fabrics, or asked for
  bool asked_ = false;
};

}  // namespace haptex::nodes
