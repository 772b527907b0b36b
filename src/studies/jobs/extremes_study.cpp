#include "haptex/studies/jobs/extremes_study.h"

#include <limits>
#include <ostream>
#include <stdexcept>

#include "haptex/base/require.h"
#include "haptex/studies/extreme_run.h"
#include "haptex/studies/extreme_shrink.h"
#include "haptex/studies/extreme_tally.h"
#include "haptex/studies/jobs/records.h"

namespace haptex::studies {
namespace {

constexpr const char* kExtremeCase = "an extreme case";
constexpr std::size_t kFields = 10;        // of a case that did not fail
constexpr std::size_t kFailedFields = 12;  // with message and shrunk case

ExtremeFailure failureCalled(const std::string& name, const std::string& record) {
  constexpr ExtremeFailure kAll[] = {ExtremeFailure::kThrew,      ExtremeFailure::kNotFinite,
                                     ExtremeFailure::kStuck,      ExtremeFailure::kEnergyGrew,
                                     ExtremeFailure::kIntersects, ExtremeFailure::kNoReturn,
                                     ExtremeFailure::kNone};
  for (const ExtremeFailure failure : kAll) {
    if (name == nameOf(failure)) return failure;
  }
  refuseRecord(record, kExtremeCase);
}

ExtremeOutcome outcomeIn(const std::vector<std::string>& fields, const std::string& record) {
  ExtremeOutcome outcome;
  outcome.failure = failureCalled(fields[1], record);
  outcome.growth = numberIn<double>(fields[2], record, kExtremeCase);
  outcome.return_error = numberIn<double>(fields[3], record, kExtremeCase);
  outcome.steps = numberIn<int>(fields[4], record, kExtremeCase);
  outcome.rejected = numberIn<int>(fields[5], record, kExtremeCase);
  outcome.settling_steps = numberIn<int>(fields[6], record, kExtremeCase);
  outcome.slow = numberIn<int>(fields[7], record, kExtremeCase) != 0;
  outcome.other_rest = numberIn<int>(fields[8], record, kExtremeCase) != 0;
  outcome.unsettled = numberIn<int>(fields[9], record, kExtremeCase) != 0;
  return outcome;
}

}  // namespace

ExtremesStudy::ExtremesStudy(const ExtremesSettings& settings) : settings_(settings) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / 2;
  if (settings.cases < 1) base::refuse("cases = 0: allowed is at least 1");
  if (settings.seed > most || settings.cases > most - settings.seed) {
    base::refuse("cases = ", settings.cases, " from seed ", settings.seed,
                 " on: allowed are seeds up to ", most);
  }
  if (!settings.self_colliding) return;
  for (const ExtremeCase& extreme : drawSelfCollidingCases(settings.seed, settings.cases)) {
    seeds_.push_back(extreme.seed);
  }
}

StudyInputs ExtremesStudy::inputs() const {
  return {{"cases", std::to_string(settings_.cases)},
          {"seed", std::to_string(settings_.seed)},
          {"self_collision", settings_.self_colliding ? "1" : "0"}};
}

ExtremeCase ExtremesStudy::caseOf(std::size_t unit) const {
  if (!settings_.self_colliding) return drawExtremeCase(settings_.seed + unit);
  ExtremeCase extreme = drawExtremeCase(seeds_[unit]);
  extreme.self_collision = true;
  return extreme;
}

std::string ExtremesStudy::run(std::size_t unit) const {
  const ExtremeCase extreme = caseOf(unit);
  const ExtremeOutcome outcome = runExtremeCase(extreme);
  std::string record = "seed=" + std::to_string(extreme.seed) + " kind=" + nameOf(extreme.kind) +
                       " method=" + cloth::nameOf(extreme.method) + '\t' + nameOf(outcome.failure);
  for (const double number : {outcome.growth, outcome.return_error}) {
    record += '\t' + textOf(number);
  }
  for (const int number : {outcome.steps, outcome.rejected, outcome.settling_steps,
                           int{outcome.slow}, int{outcome.other_rest}, int{outcome.unsettled}}) {
    record += '\t' + std::to_string(number);
  }
  if (outcome.failure == ExtremeFailure::kNone) return record;
  return record + '\t' + asField(outcome.message) + '\t' + toText(shrinkFailure(extreme, outcome));
}

void ExtremesStudy::summarise(const std::vector<std::string>& records, std::ostream& out) const {
  ExtremeTally tally;
  for (const std::string& record : records) {
    const std::vector<std::string> fields = fieldsOf(record);
    if (fields.size() != kFields && fields.size() != kFailedFields)
      refuseRecord(record, kExtremeCase);
    tally.add(parseExtremeCase(fields[0]), outcomeIn(fields, record));
  }
  tally.print(settings_.self_colliding ? "stability/self_colliding/" : "stability/",
              [&](const std::string& name, double value, const char* unit) {
                out << name << '\t' << value << '\t' << unit << '\n';
              });
}

}  // namespace haptex::studies
