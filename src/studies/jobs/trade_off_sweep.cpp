#include "haptex/studies/jobs/trade_off_sweep.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <ostream>

#include "haptex/base/checksum.h"
#include "haptex/base/require.h"
#include "haptex/studies/jobs/folder_checksum.h"
#include "haptex/studies/jobs/records.h"

namespace haptex::studies {
namespace {

constexpr const char* kTradeOffCase = "a case of the trade-off";
constexpr std::size_t kRefusedFields = 3;
constexpr std::size_t kReferenceFields = 5;  // with motion and fabric
constexpr std::size_t kPointFields = 7;

std::string folderOfFabrics(const std::string& config) { return config + "/fabrics"; }

std::string checksumOfNames(const std::vector<TradeOffPoint>& points) {
  std::uint64_t sum = base::kChecksumOfNothing;
  for (const TradeOffPoint& point : points) sum = base::checksum(nameOf(point) + '\n', sum);
  return base::digitsOf(sum);
}

void addErrors(const TradeOffErrors& errors, std::string& record) {
  for (const double number : {errors.position, errors.force, errors.energy}) {
    record += '\t' + textOf(number);
  }
}

std::string resultsOf(const TradeOffCase& of, const TradeOffSweepSettings& settings) {
  const Reference reference = computeReference(of, settings.reference);
  std::string results;
  addErrors(reference.own_error, results);
  for (const TradeOffPoint& point : settings.points) {
    if (!canFollow(of.motion, point)) continue;
    const Trajectory trajectory = follow(of.motion, of.fabric, point);
    const TradeOffResult result = compare(trajectory, reference);
    results += '\t' + nameOf(point);
    addErrors(result.error, results);
    results += result.stable ? "\t1" : "\t0";
    results += '\t' + textOf(result.solves_per_step) + '\t' + std::to_string(trajectory.steps);
  }
  return results;
}

/// Of a record with motion and fabric at least.
std::vector<std::string> fieldsOfCase(const std::string& record) {
  std::vector<std::string> fields = fieldsOf(record);
  const auto* motion = std::find_if(kMotions.begin(), kMotions.end(),
                                    [&](const NamedMotion& one) { return one.name == fields[0]; });
  const bool is_whole =
      fields.size() >= kReferenceFields && (fields.size() - kReferenceFields) % kPointFields == 0;
  if (motion == kMotions.end() || (!is_whole && fields.size() != kRefusedFields))
    refuseRecord(record, kTradeOffCase);
  return fields;
}

void tellResults(const std::vector<std::string>& fields, const std::string& record,
                 const Tell& tell) {
  const auto number = [&](std::size_t field) {
    return numberIn<double>(fields[field], record, kTradeOffCase);
  };
  const auto errors = [&](std::size_t field) {
    return TradeOffErrors{number(field), number(field + 1), number(field + 2)};
  };
  const std::string of = "trade_off/" + fields[0] + "/" + fields[1] + "/";
  tellErrors(of + "reference", errors(2), tell);
  for (std::size_t i = kReferenceFields; i < fields.size(); i += kPointFields) {
    const std::string point = of + fields[i];
    tellErrors(point, errors(i + 1), tell);
    tell(point + "/solves_per_step", number(i + 5), "1");
    tell(point + "/stable", number(i + 4), "1");
  }
}

}  // namespace

std::vector<std::string> sweptFabrics(const std::string& config) {
  const std::vector<std::string>& first = tradeOffFabrics();
  std::vector<std::string> fabrics;
  for (const auto& entry : std::filesystem::directory_iterator(folderOfFabrics(config))) {
    const std::filesystem::path& file = entry.path();
    const bool is_first = std::find(first.begin(), first.end(), file.stem()) != first.end();
    if (file.extension() == ".yaml" && !is_first) fabrics.push_back(file.stem());
  }
  std::sort(fabrics.begin(), fabrics.end());
  fabrics.insert(fabrics.begin(), first.begin(), first.end());
  return fabrics;
}

TradeOffSweep::TradeOffSweep(TradeOffSweepSettings settings) : settings_(std::move(settings)) {
  std::vector<std::string> fabrics = sweptFabrics(settings_.config);
  if (settings_.fabrics < 1 || settings_.fabrics > fabrics.size()) {
    base::refuse("cases = ", settings_.fabrics, ": allowed are 1 to ", fabrics.size(),
                 ", the fabrics of ", folderOfFabrics(settings_.config));
  }
  fabrics.resize(settings_.fabrics);
  cases_ = tradeOffCases(fabrics);
}

StudyInputs TradeOffSweep::inputs() const {
  return {{"cases", std::to_string(settings_.fabrics)},
          {"reference", std::to_string(settings_.reference.cells) + " cells, " +
                            std::to_string(settings_.reference.steps_per_cycle) + " steps"},
          {"points", checksumOfNames(settings_.points)},
          {"fabrics", checksumOfFolder(folderOfFabrics(settings_.config))}};
}

std::string TradeOffSweep::run(std::size_t unit) const {
  const TradeOffCaseName& name = cases_.at(unit);
  const TradeOffCase of = loadCase(name, settings_.config);
  const std::string begin = std::string(nameOf(name.motion)) + '\t' + name.fabric;
  try {
    return begin + resultsOf(of, settings_);
  } catch (const std::bad_alloc&) {
    throw;  // says something of the machine, and nothing of the case
  } catch (const std::exception& refusal) {
    return begin + '\t' + asField(refusal.what());
  }
}

void TradeOffSweep::summarise(const std::vector<std::string>& records, std::ostream& out) const {
  for (const std::string& record : records) {
    const std::vector<std::string> fields = fieldsOfCase(record);
    if (fields.size() == kRefusedFields) {
      out << "trade_off/" << fields[0] << '/' << fields[1] << "/refused\t" << fields[2] << "\t\n";
      continue;
    }
    tellResults(fields, record, [&](const std::string& name, double value, const char* unit) {
      out << name << '\t' << value << '\t' << unit << '\n';
    });
  }
}

}  // namespace haptex::studies
