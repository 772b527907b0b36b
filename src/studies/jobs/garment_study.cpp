#include "haptex/studies/jobs/garment_study.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <ostream>

#include "haptex/base/require.h"
#include "haptex/studies/jobs/folder_checksum.h"
#include "haptex/studies/jobs/garment_starts.h"
#include "haptex/studies/jobs/records.h"

namespace haptex::studies {
namespace {

constexpr const char* kGarmentStart = "a start of a garment";
constexpr std::size_t kStartFields = 8;
constexpr std::size_t kStartFieldsWithReason = 9;

/// What a record says.
struct StartResult {
  std::string garment;
  unsigned seed;
  bool is_sound;
  double pairs;  // at the end
  std::string why_not;
};

StartResult startResultIn(const std::string& record) {
  const std::vector<std::string> fields = fieldsOf(record);
  if (fields.size() != kStartFields && fields.size() != kStartFieldsWithReason)
    refuseRecord(record, kGarmentStart);
  const auto number = [&](std::size_t field) {
    return numberIn<double>(fields[field], record, kGarmentStart);
  };
  const bool at_rest = number(2) != 0.0;
  const double states = number(5), pairs = number(6) + number(7);
  StartResult result{fields[0], numberIn<unsigned>(fields[1], record, kGarmentStart),
                     at_rest && states == 0.0 && pairs == 0.0, pairs, ""};
  if (fields.size() == kStartFieldsWithReason) {
    result.is_sound = false;
    result.why_not = fields[8];
  } else if (!result.is_sound) {
    result.why_not = std::string(at_rest ? "at rest" : "not at rest") + ", " + fields[5] +
                     " states intersect, at the end " + base::shortNumber(pairs) + " pairs";
  }
  return result;
}

}  // namespace

GarmentStudy::GarmentStudy(GarmentSettings settings) : settings_(std::move(settings)) {
  constexpr std::size_t kMostSeeds = std::numeric_limits<unsigned>::max();
  if (settings_.starts < 1) base::refuse("cases = 0: allowed is at least 1");
  if (settings_.starts > kMostSeeds - settings_.seed) {
    base::refuse("cases = ", settings_.starts, " from seed ", settings_.seed,
                 " on: allowed are seeds up to ", kMostSeeds);
  }
}

std::size_t GarmentStudy::unitCount() const { return settings_.starts * garmentScenes().size(); }

StudyInputs GarmentStudy::inputs() const {
  return {{"cases", std::to_string(settings_.starts)},
          {"seed", std::to_string(settings_.seed)},
          {"config", checksumOfFolder(settings_.config)}};
}

std::string GarmentStudy::run(std::size_t unit) const {
  const GarmentScene& scene = garmentScenes()[unit % garmentScenes().size()];
  const auto seed = settings_.seed + static_cast<unsigned>(unit / garmentScenes().size());
  dressing::DrapeOutcome outcome;
  std::string reason;
  try {
    GarmentStart start = startOf(scene, settings_.config);
    disturb(start.laid.garment.mesh, start.laid.body, scene, seed);
    outcome = dressing::drape(start.laid.garment, start.fabrics, start.laid.body, start.settings);
  } catch (const std::exception& refusal) {
    reason = '\t' + asField(refusal.what());
  }
  std::string record = std::string(scene.garment) + '\t' + std::to_string(seed) + '\t' +
                       (outcome.at_rest ? '1' : '0');
  for (const double number : {outcome.closing_time, outcome.settling_time}) {
    record += '\t' + textOf(number);
  }
  for (const std::size_t number : {static_cast<std::size_t>(outcome.intersecting_states),
                                   outcome.with_itself, outcome.with_body}) {
    record += '\t' + std::to_string(number);
  }
  return record + reason;
}

void GarmentStudy::summarise(const std::vector<std::string>& records, std::ostream& out) const {
  std::vector<StartResult> results;
  for (const std::string& record : records) results.push_back(startResultIn(record));
  for (const GarmentScene& scene : garmentScenes()) {
    int starts = 0, sound = 0;
    double most_pairs = 0.0;
    for (const StartResult& result : results) {
      if (result.garment != scene.garment) continue;
      ++starts;
      sound += result.is_sound ? 1 : 0;
      most_pairs = std::max(most_pairs, result.pairs);
    }
    const std::string name = std::string("garment/") + scene.garment;
    out << name << "/sound\t" << sound << "\tof " << starts << '\n'
        << name << "/most_intersections\t" << most_pairs << "\tpairs\n";
  }
  for (const StartResult& result : results) {
    if (result.is_sound) continue;
    out << "garment/" << result.garment << "/start_" << result.seed << '\t' << result.why_not
        << "\t\n";
  }
}

}  // namespace haptex::studies
