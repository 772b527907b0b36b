#include "haptex/contact/haptic_layer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/contact/fabric_directions.h"

namespace haptex::contact {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const material::Fabric& requireBending(const material::Fabric& fabric,
                                       const HapticSettings& settings) {
  if (settings.layer == HapticSettings::Layer::kPatch && !fabric.bending) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                " has no bending; a patch needs it: add the key bending");
  }
  return fabric;
}

mesh::ClothMesh requireSoundAndReturn(mesh::ClothMesh mesh) {
  mesh::requireSound(mesh);
  if (!mesh.ties.empty()) {
    base::refuse("fingertips touch panels that are merged, and ", mesh.ties.size(),
                 " particles of the mesh are tied");
  }
  mesh.triangle_fabrics = fabricsOfTriangles(mesh);
  return mesh;
}

const std::vector<material::Fabric>& requireFabrics(const std::vector<material::Fabric>& fabrics,
                                                    const mesh::ClothMesh& mesh,
                                                    const HapticSettings& settings) {
  mesh::requireFabrics(mesh, fabrics.size());
  for (const material::Fabric& fabric : fabrics) requireBending(fabric, settings);
  return fabrics;
}

std::vector<ContactLaw> lawsOf(const std::vector<material::Fabric>& fabrics, int most_layers) {
  std::vector<ContactLaw> laws;
  for (const material::Fabric& fabric : fabrics)
    laws.emplace_back(fabric, PulpSettings{}, most_layers);
  return laws;
}

/// Ascending, each once.
/// @throws std::invalid_argument if one does not exist
std::vector<int> sortedTriangles(std::vector<int> triangles, const mesh::ClothMesh& mesh) {
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  const int count = static_cast<int>(mesh.triangles.size());
  if (triangles.empty() || (triangles.front() >= 0 && triangles.back() < count)) return triangles;
  std::ostringstream message;
  message << "triangle " << (triangles.front() < 0 ? triangles.front() : triangles.back())
          << " does not exist; the cloth has triangles 0 to " << count - 1;
  throw std::invalid_argument(message.str());
}

bool allFinite(const std::vector<Vector3d>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const Vector3d& vector) { return vector.allFinite(); });
}

/// The part of a contact's normal force on a point; without force all points are alike.
double shareOf(const TouchedParticle& point, const FingertipContact& contact, std::size_t points) {
  return contact.normal_force > 0.0 ? point.normal_force / contact.normal_force : 1.0 / points;
}

}  // namespace

void requireTouchable(const material::Fabric& fabric, const HapticSettings& settings) {
  ContactLaw(requireBending(fabric, settings));
}

HapticLayer::HapticLayer(mesh::ClothMesh mesh, material::Fabric fabric,
                         const cloth::ModelledEffects& effects, const HapticSettings& settings,
                         std::vector<mesh::Obstacle> obstacles)
    : HapticLayer(std::move(mesh), std::vector<material::Fabric>{std::move(fabric)}, effects,
                  settings, std::move(obstacles)) {}

HapticLayer::HapticLayer(mesh::ClothMesh mesh, std::vector<material::Fabric> fabrics,
                         const cloth::ModelledEffects& effects, const HapticSettings& settings,
                         std::vector<mesh::Obstacle> obstacles)
    : settings_(settings),
      mesh_(requireSoundAndReturn(std::move(mesh))),
      fabrics_(std::move(fabrics)),
      effects_(effects),
      laws_(lawsOf(requireFabrics(fabrics_, mesh_, settings),
                   effects.self_collision ? LayersBetween::kMost : 1)),
      obstacles_(effects.contacts ? std::move(obstacles) : std::vector<mesh::Obstacle>(), fabrics_),
      topology_(mesh_),
      motion_(mesh_.rest_coordinates.size()),
      panel_forces_(mesh_.panelCount(), 0.0) {
  if (settings.layer == HapticSettings::Layer::kWholeCloth) {
    whole_cloth_ = std::make_unique<WholeClothContact>(mesh_, fabrics_, laws_);
  }
  loads_.reserve(cloth::PointLoads::kMax);
  for (FingertipContact& contact : contacts_.values) contact.points.reserve(kMaxContactPoints);
}

std::unique_ptr<Patch> HapticLayer::preparePatch(const std::vector<int>& triangles,
                                                 const std::vector<char>& attached,
                                                 const std::vector<int>& around) const {
  if (attached.size() != mesh_.rest_coordinates.size()) {
    std::ostringstream message;
    message << "attached has " << attached.size() << " entries; the cloth has "
            << mesh_.rest_coordinates.size() << " particles";
    throw std::invalid_argument(message.str());
  }
  std::vector<int> cut = sortedTriangles(triangles, mesh_), outside;
  if (cut.empty()) return nullptr;
  const std::vector<int> others = sortedTriangles(around, mesh_);
  std::set_difference(others.begin(), others.end(), cut.begin(), cut.end(),
                      std::back_inserter(outside));
  RefinedCut refined = cutAndRefine(mesh_, topology_, std::move(cut), attached,
                                    settings_.refinement, std::move(outside));
  if (refined.free_count == 0) return nullptr;
  return std::make_unique<Patch>(mesh_, std::move(refined), fabrics_, effects_, laws_, &obstacles_);
}

std::vector<int> HapticLayer::elementsAround(const std::vector<int>& triangles,
                                             double reach) const {
  if (effects_.self_collision) return {};
  return contact::elementsAround(mesh_, topology_, triangles, reach);
}

void HapticLayer::receive(const std::vector<Vector3d>& positions,
                          const std::vector<Vector3d>& velocities, double period, double time) {
  if (positions.size() != motion_.particleCount() || velocities.size() != positions.size()) {
    std::ostringstream message;
    message << "the state has " << positions.size() << " positions and " << velocities.size()
            << " velocities; the cloth has " << motion_.particleCount() << " particles";
    throw std::invalid_argument(message.str());
  }
  if (!std::isfinite(time)) {
    std::ostringstream message;
    message << "the time of the state is " << time << " s; it must be finite";
    throw std::invalid_argument(message.str());
  }
  if (!std::isfinite(period) || period <= 0.0) {
    std::ostringstream message;
    message << "the period of the state is " << period << " s; it must be finite and > 0";
    throw std::invalid_argument(message.str());
  }
  if (!allFinite(positions) || !allFinite(velocities)) {
    throw std::invalid_argument("the state has a number that is not finite");
  }
  for (const Finger finger : kFingers) {
    auto& [earlier, last] = places_at_states_[finger];
    earlier = last;
    last.reset();
    if (held_[finger].held()) last = held_[finger].held()->position;
  }
  const bool first = !motion_.hasState();
  motion_.receive(positions, period, time);
  if (whole_cloth_) whole_cloth_->receive(positions, velocities, period);
  if (!first || !patch_) return;
  obstacles_.moveTo(motion_.time());
  patch_->start(motion_);
}

std::unique_ptr<Patch> HapticLayer::exchange(std::unique_ptr<Patch> next) {
  obstacles_.moveTo(motion_.time());
  if (next && patch_) {
    next->goOnFrom(*patch_, motion_);
  } else if (next) {
    next->start(motion_);
  }
  std::swap(patch_, next);
  if (!patch_) startAgain();
  for (const Finger finger : kFingers) {
    const bool touched = next && !next->contact(finger).touched().empty();
    held_[finger].sweepFrom(touched ? std::nullopt : places_at_states_[finger][0]);
  }
  return next;
}

void HapticLayer::startAgain() {
  if (patch_) patch_->start(motion_);
  stiffness_.clear();
  loads_.clear();
  for (FingertipContact& contact : contacts_.values) {
    std::vector<ContactPoint> points = std::move(contact.points);
    points.clear();
    contact = FingertipContact();
    contact.points = std::move(points);
  }
}

void HapticLayer::step(const Fingertips& fingertips) {
  hold(fingertips);
  loads_.clear();
  last_step_accepted_ = true;
  if (!motion_.hasState()) return;
  motion_.advance(settings_.time_step);
  if (whole_cloth_) {
    stepWholeCloth();
  } else if (patch_) {
    stepPatch();
  }
}

/// Who is in contact, and where.
void HapticLayer::hold(const Fingertips& fingertips) {
  fingertips_ = fingertips;
  for (const Finger finger : kFingers) {
    const std::optional<Fingertip>& next = fingertips_[finger];
    HeldFingertip& held = held_[finger];
    present_[finger] = nullptr;
    if (!next || !isSound(*next)) {
      held.clear();
      continue;
    }
    if (!motion_.hasState() || (!whole_cloth_ && !patch_)) {
      present_[finger] = &held.follow(*next);
      continue;
    }
    const Particles particles =
        whole_cloth_ ? whole_cloth_->particles() : patch_->particles(finger);
    const SphereContact& contact =
        whole_cloth_ ? whole_cloth_->contact(finger) : patch_->contact(finger);
    const ContactLaw& under = law(fabricUnder(contact.touched()));
    present_[finger] = &held.move(*next, particles, contact.touched(),
                                  next->radius + under.halfThickness(), under.friction());
  }
}

int HapticLayer::fabricOf(int particle) const {
  return whole_cloth_ ? whole_cloth_->fabricOf(particle) : patch_->fabricOf(particle);
}

/// The one on which most of the normal force is; without force the first.
int HapticLayer::fabricUnder(const std::vector<TouchedParticle>& touched) const {
  if (fabrics_.size() == 1) return 0;
  std::array<double, mesh::kMostFabrics> forces{};
  for (const TouchedParticle& point : touched)
    forces[fabricOf(point.particle)] += point.normal_force;
  return static_cast<int>(std::max_element(forces.begin(), forces.end()) - forces.begin());
}

void HapticLayer::stepPatch() {
  obstacles_.moveTo(motion_.time());
  if (!patch_->advance(motion_, present_, settings_.time_step)) {
    startAgain();
    last_step_accepted_ = false;
    return;
  }
  stiffness_.update(*patch_, settings_.time_step);
  for (const Finger finger : kFingers) {
    fillContact(finger, patch_->contact(finger).touched(), patch_->particles(finger));
  }
  for (const Finger finger : kFingers) {
    const std::vector<TouchedParticle>& touched = patch_->contact(finger).touched();
    FingertipContact& contact = contacts_[finger];
    if (!contact.touching) continue;
    if (!held_[finger].isHeld()) contact.stiffness = stiffness_.of(finger);
    // Every point goes back with its own spring, although the patch behind it makes that softer: a
    // part of the cloth that hangs around the fingertip flutters from one large-scale step to the
    // next if less holds it. Equilibrium takes some more steps for it.
    Matrix3d stiffness = Matrix3d::Zero();
    for (const TouchedParticle& point : touched) stiffness += point.tangent;
    const Vector3d ahead = aheadOf(finger, stiffness);
    const RefinedCut& cut = patch_->cut();
    sendBack(
        contact, touched, [this](int particle) { return patch_->restCoordinates(particle); },
        [&](const TouchedParticle& point) {
          return cloth::PointLoad{cut.owners[point.particle], cut.weights[point.particle],
                                  patch_->placeOnCloth(point.particle, motion_) + ahead,
                                  point.force(), point.tangent};
        });
  }
}

/// How far the fingertip will have taken its contact along when the large-scale layer has made its
/// next step. A fingertip that withdraws takes no more than its force away, but for what the other
/// one pushes after it. Cloth that hangs overshoots less where only the period counts; cloth that
/// slides on an obstacle, which stops it, would be felt to be held by more than friction, and what
/// a pinch carries with elements around it would be behind.
Vector3d HapticLayer::aheadOf(Finger finger, const Matrix3d& stiffness) const {
  if (!settings_.predict) return Vector3d::Zero();
  const FingertipContact& contact = contacts_[finger];
  const bool goes_on = patch_->cut().isSurrounded() || patch_->touchesObstacle();
  const double seconds = motion_.period() + (goes_on ? motion_.remaining() : 0.0);
  const Vector3d followed = -seconds * followingSpeed(finger) * contact.normal;
  const Vector3d ahead = seconds * contact.velocity - followed;
  // Friction may pull a fingertip at rest along the mean normal.
  const double now = std::max(0.0, -contact.normal.dot(contact.force));
  const double change = contact.normal.dot(stiffness * ahead);
  return followed + (change < -now ? Vector3d(now / -change * ahead) : ahead);
}

/// How fast (m/s) the fingertip withdraws and the other one, on the other side of the cloth,
/// follows it: the cloth between the fingers of a pinch goes along with them.
double HapticLayer::followingSpeed(Finger finger) const {
  if (!isPinched()) return 0.0;
  const FingertipContact& contact = contacts_[finger];
  const FingertipContact& other =
      contacts_[finger == Finger::kIndex ? Finger::kThumb : Finger::kIndex];
  return std::max(
      0.0, std::min(-contact.normal.dot(contact.velocity), -contact.normal.dot(other.velocity)));
}

bool HapticLayer::isPinched() const {
  const FingertipContact& index = contacts_[Finger::kIndex];
  const FingertipContact& thumb = contacts_[Finger::kThumb];
  return index.touching && thumb.touching && index.normal.dot(thumb.normal) < 0.0;
}

void HapticLayer::stepWholeCloth() {
  whole_cloth_->step(present_);
  for (const Finger finger : kFingers) {
    const std::vector<TouchedParticle>& touched = whole_cloth_->contact(finger).touched();
    fillContact(finger, touched, whole_cloth_->particles());
    FingertipContact& contact = contacts_[finger];
    if (!contact.touching) continue;
    if (!held_[finger].isHeld()) {
      contact.stiffness = whole_cloth_->stiffness(finger, settings_.time_step);
    }
    sendBack(
        contact, touched, [this](int particle) { return whole_cloth_->restCoordinates(particle); },
        [this](const TouchedParticle& point) {
          return cloth::PointLoad{whole_cloth_->triangleOf(point.particle),
                                  Vector3d::Unit(whole_cloth_->cornerOf(point.particle)),
                                  whole_cloth_->particles().positions[point.particle],
                                  point.force(), point.stiffness};
        });
  }
}

/// What goes back to the cloth, and where on the panel with most of the normal force that is.
/// @param rest_of a particle's rest coordinates @param load_of the load of a touched particle
template <typename RestOf, typename LoadOf>
void HapticLayer::sendBack(FingertipContact& contact, const std::vector<TouchedParticle>& touched,
                           const RestOf& rest_of, const LoadOf& load_of) {
  std::fill(panel_forces_.begin(), panel_forces_.end(), 0.0);
  for (const TouchedParticle& point : touched) {
    panel_forces_[mesh_.panelOf(load_of(point).triangle)] +=
        shareOf(point, contact, touched.size());
  }
  const auto most = std::max_element(panel_forces_.begin(), panel_forces_.end());
  Eigen::Matrix<double, 3, 2> directions = Eigen::Matrix<double, 3, 2>::Zero();
  for (const TouchedParticle& point : touched) {
    const cloth::PointLoad load = load_of(point);
    if (loads_.size() < loads_.capacity()) loads_.push_back(load);
    if (mesh_.panelOf(load.triangle) != most - panel_forces_.begin()) continue;
    const double share = shareOf(point, contact, touched.size()) / *most;
    contact.fabric_position += share * rest_of(point.particle);
    directions += share * fabricDirections(mesh_, load.triangle, motion_);
  }
  contact.to_fabric = toFabric(directions);
  contact.fabric_velocity = contact.to_fabric * contact.sliding_velocity;
}

void HapticLayer::fillContact(Finger finger, const std::vector<TouchedParticle>& touched,
                              const Particles& particles) {
  FingertipContact& contact = contacts_[finger];
  std::vector<ContactPoint> points = std::move(contact.points);
  points.clear();
  contact = FingertipContact();
  contact.points = std::move(points);
  contact.touching = !touched.empty();
  if (!contact.touching) return;
  contact.fabric = fabricUnder(touched);
  const Fingertip& fingertip = *present_[finger];
  contact.position = fingertips_[finger]->position;
  contact.velocity = fingertips_[finger]->velocity;
  double slipping = 0.0;
  for (const TouchedParticle& point : touched) contact.normal_force += point.normal_force;
  for (const TouchedParticle& point : touched) {
    const double share = shareOf(point, contact, touched.size());
    const Vector3d& place = particles.positions[point.particle];
    contact.force -= point.force();
    if (!held_[finger].isHeld()) contact.damping += point.damping;
    contact.area += particles.areas[point.particle];
    contact.penetration = std::max(contact.penetration, point.depth);
    contact.centre += share * place;
    contact.normal += share * point.normal;
    contact.sliding_velocity +=
        share * (fingertip.velocity + fingertip.angular_velocity.cross(place - fingertip.position) -
                 particles.velocities[point.particle]);
    if (point.slips) slipping += share;
    if (contact.points.size() < kMaxContactPoints) {
      contact.points.push_back({place, point.normal, point.normal_force, point.friction});
    }
  }
  contact.slipping = slipping >= 0.5;
  contact.normal.normalize();
  contact.sliding_velocity -= contact.normal * contact.normal.dot(contact.sliding_velocity);
}

}  // namespace haptex::contact
