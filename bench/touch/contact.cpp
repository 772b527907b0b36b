// What accuracy of the two layers costs: error of the stretched sample's force against the whole
// cloth at the resolution of the patch, and the time of a millisecond. bench_contact CSV writes the
// curves of scripts/plot_contact instead: friction over the displacement with reversals, and force
// against depth at several refinements.
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "tab_lines.h"

namespace {

using namespace haptex::oracles;
using Eigen::Vector3d;
using haptex::base::Finger;
using haptex::bench::printLine;
using haptex::material::Fabric;

const Vector3d kStill = Vector3d::Zero();
const Vector3d kMiddle(0.0, 0.0, -0.5 * kSampleSide);
constexpr double kStrain = 0.005;  // of the taut sample
constexpr double kRate = 80.0;     // Hz, large-scale
constexpr double kTick = 1e-3;     // s

/// The force along the way against where the pinched fingertips are: 1 mm up, 2 mm down, 2 mm up.
void writeFriction(const Fabric& fabric, std::ostream& csv) {
  HapticLoop loop(tautSample(fabric, kStrain, kRate));
  Hand hand;
  hand.middle = kMiddle;
  hand.gap = 2.0 * loop.layer().law().halfThickness();
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, -8e-4, 0.2, kTick, step);
  move(hand, kStill, 0.0, 0.2, kTick, step);
  double at = 0.0;
  for (double target : {1e-3, -1e-3, 1e-3}) {
    const double way = target - at;
    move(hand, {0.0, 0.0, way}, 0.0, std::abs(way) / 0.005, kTick,
         [&](const Fingertips& fingertips) {
           loop.step(fingertips);
           const double place = fingertips[Finger::kIndex]->position.z() - kMiddle.z();
           double normal = 0.0;
           for (const auto& contact : loop.layer().contacts().values) {
             normal += std::abs(contact.force.x());
           }
           csv << "friction," << place << ',' << -forceOnFingertips(loop.layer()).z() << '\n';
           csv << "limit," << place << ',' << *fabric.friction * normal << '\n';
         });
    at = target;
  }
}

void writePress(const Fabric& fabric, int refinement, std::ostream& csv) {
  HapticLoopSettings sample = tautSample(fabric, kStrain, kRate);
  sample.haptics.refinement = refinement;
  HapticLoop loop(sample);
  haptex::contact::Fingertip fingertip;
  fingertip.radius = kIndexRadius;
  for (int i = 0; i <= 50; ++i) {
    const double depth = 1e-4 * i;
    fingertip.position =
        kMiddle + Vector3d(kIndexRadius + loop.layer().law().halfThickness() - depth, 0.0, 0.0);
    loop.rest({fingertip, std::nullopt}, 0.05);
    csv << "press_level_" << refinement << ',' << depth << ','
        << loop.layer().contacts()[Finger::kIndex].force.x() << '\n';
  }
}

int writeCurves(const Fabric& fabric, const char* path) {
  std::ofstream csv(path);
  csv << "curve,x,y\n";
  writeFriction(fabric, csv);
  for (int refinement = 0; refinement <= 3; ++refinement) writePress(fabric, refinement, csv);
  csv.close();
  if (csv) return 0;
  std::cerr << "bench_contact: " << path << ": cannot be written\n";
  return 1;
}

/// Stretches the sample by 1 mm along the warp and waits until it rests.
template <typename Step>
void stretch(double h, const Step& step) {
  Hand hand;
  hand.middle.z() = -0.19;
  hand.gap = 4e-3;
  move(hand, kStill, -11e-3, 0.4, h, step);
  move(hand, {0.0, 0.0, -1e-3}, 0.0, 0.2, h, step);
  move(hand, kStill, 0.0, 1.0, h, step);
}

void compareWithReference(const Fabric& fabric, int refinement) {
  HapticLoopSettings sample = hangingSample(fabric, haptex::kes::Direction::kWarp, kRate);
  sample.haptics.refinement = refinement;
  RefinedCloth reference(sample);
  stretch(0.05, [&](const Fingertips& fingertips) { reference.step(fingertips, 0.05); });
  const double exact = (reference.force(Finger::kIndex) + reference.force(Finger::kThumb)).z();
  for (double margin : {4e-3, 8e-3, 12e-3}) {
    sample.haptics.margin = margin;
    sample.haptics.most_elements = 200;  // the margin alone decides
    HapticLoop loop(sample);
    const auto begin = std::chrono::steady_clock::now();
    stretch(kTick, [&](const Fingertips& fingertips) { loop.step(fingertips); });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    const double force = forceOnFingertips(loop.layer()).z();
    const std::string name = "contact/level_" + std::to_string(refinement) + "/margin_" +
                             std::to_string(std::lround(1e3 * margin)) + "mm";
    printLine(name + "/particles", static_cast<double>(loop.layer().particleCount()), "1");
    printLine(name + "/stretch_error", 100.0 * (force - exact) / exact, "%");
    printLine(name + "/both_layers", 1e3 * taken.count() / (loop.time() / kTick), "ms/tick");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Fabric wool = haptex::material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  if (argc == 2) return writeCurves(wool, argv[1]);
  for (int refinement = 0; refinement <= 2; ++refinement) compareWithReference(wool, refinement);
  return 0;
}
