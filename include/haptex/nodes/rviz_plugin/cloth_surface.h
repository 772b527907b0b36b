// The vertices of a drawn cloth from the messages that say where it is.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/ContactForces.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptex/appearance/brdf.h"
#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/material/fabric.h"
#include "haptex/nodes/common/proximity_messages.h"
#include "haptex/nodes/rviz_plugin/colour_scale.h"
#include "haptex/proximity/sky_occlusion.h"

namespace haptex::nodes {

/// Red, green, blue and opacity from 0 to 255, in this order in memory.
using VertexColour = std::array<std::uint8_t, 4>;

/// The triangles of one cloth/mesh, coloured and shaded for a state. A vertex is a particle, or
/// several where triangles of different colours (fabrics, panels) meet. The shading is that of the
/// markers: a fixed light by Lambert's law on normals averaged around each particle, the same for
/// both sides; it is part of the colours. Looks take its place by reflectances. Particles that are
/// left out of the computation are grey.
class ClothSurface {
 public:
  /// Beyond it nothing is drawn: the renderer's numbers have 24 bits.
  static constexpr double kFarthest = 1e4;  ///< m

  /// @throws std::exception naming field, value and what is allowed, as restMesh() and, with
  ///   colours by stress, fabricsOfCloth()
  ClothSurface(const haptex::ClothMesh& mesh, ColourBy colour_by);

  /// Of the scale's last colour, in its unit, finite and >= 0; 0: that of scaleOf().
  void setFullScale(double full);
  /// From 0 to 1.
  void setOpacity(double opacity);

  /// Where the next state is seen from (m, finite, in the frame of states), which self-shadow and
  /// looks depend on. Without an eye there is neither.
  void setEye(const std::optional<Eigen::Vector3d>& eye);

  /// Whether the next state is darkened by the share of the sky that is seen past the cloth from
  /// the side that is towards the eye. If not, nothing of that is computed.
  void setSelfShadow(bool wanted);

  /// Only with ColourBy::kLook: of every fabric, or none, which is drawn grey. The
  /// next state has colours (sRGB) by the light of shade(), an even sky and a sun whose shadows are
  /// left out, on the side that is towards the eye.
  /// @throws std::invalid_argument if there is not one for each fabric, or colours are by another
  void setLooks(std::vector<std::shared_ptr<const appearance::Brdf>> looks);

  /// The last state from another eye: colours() anew by the shares of the sky that are known.
  /// Nothing changes where that state was computed without an eye.
  void seeFrom(const Eigen::Vector3d& eye);

  /// Forces of another mesh are ignored. They are shown until others come.
  void take(const haptex::ContactForces& forces);

  /// Computes positions() and colours().
  /// @throws std::invalid_argument naming what is wrong: positions of another number, or one that
  ///   is not finite or beyond kFarthest
  void take(const haptex::ClothState& state);

  /// Whether a state is of this mesh; all others are to be left out.
  bool knows(const haptex::ClothState& state) const { return state.mesh == mesh_; }

  std::size_t vertexCount() const { return particles_.size(); }
  /// m, three per vertex, in the frame of the state.
  const std::vector<float>& positions() const { return positions_; }
  const std::vector<VertexColour>& colours() const { return colours_; }
  /// Three vertices per triangle.
  const std::vector<std::uint32_t>& triangles() const { return triangle_vertices_; }
  /// Two vertices per edge that runs along weft or warp.
  const std::vector<std::uint32_t>& grainLines() const { return grain_lines_; }
  /// A vertex of each attached particle that is computed.
  std::vector<std::uint32_t> attached(const haptex::ClothState& state) const;
  /// m, of the box around all positions.
  const Eigen::Vector3f& low() const { return low_; }
  const Eigen::Vector3f& high() const { return high_; }

  /// With the full scale; only where the colours are of a quantity.
  const ColourScale& scale() const { return scale_; }
  ColourBy colourBy() const { return colour_by_; }
  /// What the distinct colours stand for, in the order of distinctColour(); empty for a
  /// scale.
  const std::vector<std::string>& groups() const { return groups_; }

 private:
  using Triangle = std::array<int, 3>;

  std::vector<int> groupsOfTriangles(const haptex::ClothMesh& mesh, const RestMesh& rest);
  void makeVertices(const std::vector<int>& groups);
  void findGrainLines(const RestMesh& rest);
  void shareOutAreas();
  void readPositions(const haptex::ClothState& state);
  void sumTriangles();
  void sumAxes();
  double valueOf(std::size_t triangle, const cloth::MembraneStrain& strain) const;
  double valueAt(int particle) const;
  double skyShareAt(int particle) const;
  void markExcluded(const haptex::ClothState& state);
  void colourVertices();
  VertexColour lookOf(std::size_t vertex, const appearance::Brdf& brdf,
                      const Eigen::Vector3d& normal, double sky) const;

  std::uint32_t mesh_;
  ColourBy colour_by_;
  ColourScale scale_;
  double opacity_ = 1.0;
  std::optional<Eigen::Vector3d> eye_;
  bool self_shadow_ = false;
  std::optional<linear::ThreadPool> sky_threads_;                 // once there was self-shadow
  std::optional<proximity::SkyOcclusion> sky_;                    // likewise
  const std::vector<proximity::SkyShare>* sky_shares_ = nullptr;  // of sky_, with an eye
  std::vector<Triangle> triangles_;                               // of particles
  std::vector<int> triangle_fabrics_;                             // empty: all are of the first
  std::vector<cloth::RestTriangle> at_rest_;  // of every triangle; strain, stress and look only
  std::vector<material::Fabric> fabrics_;     // only for stress
  std::vector<std::string> groups_;
  std::size_t fabric_count_;
  std::vector<std::shared_ptr<const appearance::Brdf>> looks_;  // of every fabric, or empty

  std::vector<int> particles_;                  // of every vertex
  std::vector<int> vertex_groups_;              // likewise
  std::vector<Eigen::Vector3f> wefts_, warps_;  // likewise, sums of unit axes; only for looks
  std::vector<std::uint32_t> first_vertices_;   // of every particle
  std::vector<std::uint32_t> triangle_vertices_, grain_lines_;

  std::vector<Eigen::Vector3d> points_;  // of every particle, m
  // Likewise, over the triangles around it: a normal as long as twice their area now, m^2, and
  // their values times their areas at rest.
  std::vector<Eigen::Vector4f> sums_;
  std::vector<double> areas_;           // likewise, of the triangles at rest, m^2
  std::vector<char> excluded_;          // likewise
  std::vector<double> contact_forces_;  // likewise, N
  std::vector<float> positions_;
  std::vector<VertexColour> colours_;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero(), high_ = Eigen::Vector3f::Zero();
};

}  // namespace haptex::nodes
