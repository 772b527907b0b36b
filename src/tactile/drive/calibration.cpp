#include "haptex/tactile/drive/calibration.h"

#include <sstream>
#include <vector>

#include "haptex/base/yaml_reader.h"

namespace haptex::tactile {
namespace {

using base::YamlValue;

constexpr double kMicrometre = 1e-6;            // m
constexpr double kLargestMicrometres = 1000.0;  // far beyond what piezoelectric benders do

/// um in the file, m returned.
double readDisplacement(const YamlValue& value, double least) {
  const double micrometres = value.number();
  if (micrometres < least || micrometres > kLargestMicrometres) {
    std::ostringstream reason;
    reason << "is not allowed, allowed are numbers from " << least << " to " << kLargestMicrometres
           << " (um)";
    value.refuse(reason.str());
  }
  return kMicrometre * micrometres;
}

/// One number for all contactors, or one for each.
PerContactor<double> readDisplacements(const YamlValue& finger, const std::string& key,
                                       double least) {
  const YamlValue value = finger.at(key);
  PerContactor<double> displacements;
  if (value.isList()) {
    const std::vector<YamlValue> items = value.items(kContactors);
    for (int i = 0; i < kContactors; ++i) displacements[i] = readDisplacement(items[i], least);
  } else {
    displacements.fill(readDisplacement(value, least));
  }
  return displacements;
}

ArrayCalibration readArray(const YamlValue& finger) {
  constexpr double kLeastFull = 0.01;  // um: less is no contactor
  finger.requireKeys({"full_displacement_40", "full_displacement_320", "largest_displacement"});
  const PerContactor<double> slow = readDisplacements(finger, "full_displacement_40", kLeastFull);
  const PerContactor<double> fast = readDisplacements(finger, "full_displacement_320", kLeastFull);
  const PerContactor<double> largest = readDisplacements(finger, "largest_displacement", 0.0);
  ArrayCalibration array;
  for (int i = 0; i < kContactors; ++i) array[i] = {{slow[i], fast[i]}, largest[i]};
  return array;
}

}  // namespace

Calibration loadCalibration(const std::string& path) {
  const YamlValue file = YamlValue::load(path);
  file.requireKeys({"source", "index", "thumb"});
  file.at("source").text();  // for whoever reads the file: where the numbers come from
  Calibration calibration;
  for (const base::Finger finger : base::kFingers) {
    calibration[finger] = readArray(file.at(base::name(finger)));
  }
  return calibration;
}

ArrayDrive driveFor(const ArrayAmplitudes& amplitudes, const ArrayCalibration& calibration) {
  ArrayDrive drive;
  for (int i = 0; i < kContactors; ++i) {
    const ContactorCalibration& contactor = calibration[i];
    const double displacement = amplitudes[i][k40] + amplitudes[i][k320];
    double factor = 1.0;
    if (displacement > contactor.largest_displacement) {
      factor = contactor.largest_displacement / displacement;
    }
    double together = 0.0;
    for (const Channel channel : {k40, k320}) {
      drive[i][channel] = factor * amplitudes[i][channel] / contactor.full_displacement[channel];
      together += drive[i][channel];
    }
    if (together > 1.0) {
      for (double& share : drive[i]) share /= together;
    }
  }
  return drive;
}

ArrayAmplitudes amplitudesOf(const ArrayDrive& drive, const ArrayCalibration& calibration) {
  ArrayAmplitudes amplitudes;
  for (int i = 0; i < kContactors; ++i) {
    for (const Channel channel : {k40, k320}) {
      amplitudes[i][channel] = drive[i][channel] * calibration[i].full_displacement[channel];
    }
  }
  return amplitudes;
}

}  // namespace haptex::tactile
