#include "haptex/nodes/rviz_plugin/system_status.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using Mood = StatusLine::Mood;

constexpr char kCloth[] = "cloth simulation";
constexpr char kLink[] = "exoskeleton link";
constexpr char kDriverLoop[] = "exoskeleton loop";
constexpr char kForceLoop[] = "force loop";
constexpr char kSources[] = "force sources";
constexpr double kShortestRate = 0.1;  // s, between two diagnoses that have a rate
constexpr char kNoForce[] = "no force: ";

std::string ofFinger(const char* what, Finger finger) {
  return std::string(what) + " of the " + base::name(finger);
}

std::string valueIn(const Diagnosis& diagnosis, const std::string& key) {
  const auto found = diagnosis.values.find(key);
  return found == diagnosis.values.end() ? std::string() : found->second;
}

/// NaN where there is none.
double numberIn(const Diagnosis& diagnosis, const std::string& key) {
  const std::string text = valueIn(diagnosis, key);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? std::strtod("nan", nullptr) : number;
}

std::string formatted(const char* format, double number) {
  char text[64];
  std::snprintf(text, sizeof(text), format, number);
  return text;
}

std::string secondsText(base::Time time) { return formatted("%.0f s", base::seconds(time)); }

/// What is said after "no force: ", which the line says itself.
std::string reasonIn(const std::string& message) {
  const std::size_t length = sizeof(kNoForce) - 1;
  return message.compare(0, length, kNoForce) == 0 ? message.substr(length) : message;
}

}  // namespace

void SystemStatus::hear(const std::string& name, Diagnosis diagnosis, Time now) {
  Heard heard{std::move(diagnosis), now, std::nullopt, 0.0};
  const auto before = heard_.find(name);
  const double seconds =
      before != heard_.end() ? heard.diagnosis.stamp - before->second.diagnosis.stamp : 0.0;
  if (seconds >= kShortestRate) {
    const auto since = [&](const char* key) {
      return numberIn(heard.diagnosis, key) - numberIn(before->second.diagnosis, key);
    };
    const double periods = since("periods");
    if (periods >= 0.0) heard.rate = periods / seconds;
    const double missed = since("periods missed");
    if (missed > 0.0) heard.missed_lately = missed;
  }
  if (heard.diagnosis.replayed_by.empty()) forgetReplay();
  heard_[name] = std::move(heard);
}

/// When nodes speak themselves.
void SystemStatus::forgetReplay() {
  for (auto entry = heard_.begin(); entry != heard_.end();) {
    entry = entry->second.diagnosis.replayed_by.empty() ? std::next(entry) : heard_.erase(entry);
  }
}

void SystemStatus::hear(DeviceState state, Time now) {
  device_ = std::move(state);
  device_time_ = now;
}

const SystemStatus::Heard* SystemStatus::find(const std::string& name) const {
  const auto found = heard_.find(name);
  return found == heard_.end() ? nullptr : &found->second;
}

bool SystemStatus::isLive(const std::string& name, Time now) const {
  const Heard* heard = find(name);
  return heard != nullptr && now - heard->time <= kSilent;
}

StatusLine SystemStatus::line(Time now) const {
  if (heard_.empty() && !device_) {
    return {Mood::kTrouble,
            "Nothing is heard from haptex: is a launch file running, and rviz in its namespace?"};
  }
  if (const auto line = replay(now)) return *line;
  if (const auto trouble = clothTrouble(now)) return *trouble;
  if (const auto trouble = deviceTrouble(now)) return *trouble;
  if (const auto trouble = forceTrouble(now)) return *trouble;
  return allIsWell(now);
}

/// If the newest that was heard is replayed.
std::optional<StatusLine> SystemStatus::replay(Time now) const {
  const auto earlier = [](const auto& a, const auto& b) { return a.second.time < b.second.time; };
  const auto newest = std::max_element(heard_.begin(), heard_.end(), earlier);
  if (newest == heard_.end() || newest->second.diagnosis.replayed_by.empty()) return std::nullopt;
  const Time silent = now - newest->second.time;
  const std::string felt = feelings();
  return StatusLine{
      Mood::kAttention,
      "A bag is replayed by " + newest->second.diagnosis.replayed_by +
          ", and no node answers the buttons." +
          (felt.empty() ? "" : " It recorded: " + felt + ".") +
          (silent > kSilent ? " Nothing has come for " + secondsText(silent) + "." : "")};
}

std::optional<StatusLine> SystemStatus::clothTrouble(Time now) const {
  const Heard* cloth = find(kCloth);
  if (cloth == nullptr) return std::nullopt;  // an exoskeleton alone
  if (!isLive(kCloth, now)) {
    return StatusLine{Mood::kTrouble, "No force: cloth_simulation has been silent for " +
                                          secondsText(now - cloth->time) +
                                          ". It has stopped or hangs; see its terminal."};
  }
  if (cloth->diagnosis.level == Diagnosis::Level::kError) {
    return StatusLine{Mood::kTrouble, "The cloth stands: " + cloth->diagnosis.message};
  }
  return std::nullopt;
}

std::optional<StatusLine> SystemStatus::deviceTrouble(Time now) const {
  const Heard* link = find(kLink);
  if (link == nullptr && !device_) return std::nullopt;  // the cloth alone
  const Time last = std::max(link != nullptr ? link->time : Time{}, device_time_);
  const bool live = isLive(kLink, now) || (device_ && now - device_time_ <= kDeviceSilent);
  if (!live) {
    return StatusLine{Mood::kTrouble, "No force: exoskeleton_driver has been silent for " +
                                          secondsText(now - last) +
                                          ". It has stopped or hangs; see its terminal."};
  }
  if (link != nullptr && link->diagnosis.level == Diagnosis::Level::kError) {
    return StatusLine{Mood::kTrouble, "No force: " + link->diagnosis.message +
                                          ". Are cable, power and port right?"};
  }
  return stateTrouble();
}

std::optional<StatusLine> SystemStatus::stateTrouble() const {
  if (!device_ || device_->state == "ENABLED") return std::nullopt;
  const std::string enable = device_->is_homed ? "press Enable" : "press Home, then Enable";
  if (device_->state == "FAULT") {
    return StatusLine{Mood::kTrouble, "No force: " + device_->fault + ". Press Clear fault, then " +
                                          (device_->is_homed ? "Enable." : "Home and Enable.")};
  }
  if (device_->is_busy) {
    return StatusLine{Mood::kAttention, "No force yet: the device is homing."};
  }
  if (device_->state == "PAUSED") {
    return StatusLine{Mood::kAttention, "No force: the device is paused; press Enable."};
  }
  return StatusLine{Mood::kAttention, "No force: the device is disabled; " + enable + "."};
}

std::optional<StatusLine> SystemStatus::forceTrouble(Time now) const {
  if (find(kLink) == nullptr && !device_) return std::nullopt;
  const Heard* sources = find(kSources);
  if (sources == nullptr) {
    return StatusLine{Mood::kAttention,
                      "No force: no force_renderer is heard, so nobody computes one "
                      "(haptex.launch starts it)."};
  }
  if (!isLive(kSources, now)) {
    return StatusLine{Mood::kTrouble, "No force: force_renderer has been silent for " +
                                          secondsText(now - sources->time) +
                                          ". It has stopped or hangs; see its terminal."};
  }
  if (sources->diagnosis.level != Diagnosis::Level::kOk) {
    return StatusLine{Mood::kTrouble, "No force: " + reasonIn(sources->diagnosis.message) + "."};
  }
  for (const Finger finger : kFingers) {
    const Heard* rendered = find(ofFinger("exoskeleton force", finger));
    const Heard* computed = find(ofFinger("contact force", finger));
    const bool touches = computed != nullptr && computed->diagnosis.message == "touches";
    if (rendered == nullptr || !touches) continue;
    const std::string& message = rendered->diagnosis.message;
    if (message.compare(0, sizeof(kNoForce) - 1, kNoForce) == 0) {
      return StatusLine{Mood::kTrouble, std::string("No force on the ") + base::name(finger) +
                                            ", which touches: " + reasonIn(message) + "."};
    }
  }
  return std::nullopt;
}

/// Of both fingers, in a clause each.
std::string SystemStatus::feelings() const {
  std::string text;
  for (const Finger finger : kFingers) {
    const Heard* force = find(ofFinger("contact force", finger));
    if (force == nullptr) continue;
    const std::string& message = force->diagnosis.message;
    text += text.empty() ? "the " : ", the ";
    text += std::string(base::name(finger)) + " ";
    if (message == "touches") {
      text += "feels " + formatted("%.2f N", numberIn(force->diagnosis, "force (N)"));
    } else {
      text += message == "the force rises" ? "feels a rising force" : message;
    }
  }
  return text;
}

StatusLine SystemStatus::allIsWell(Time now) const {
  const Heard* cloth = find(kCloth);
  const bool paused = cloth != nullptr && cloth->diagnosis.message.rfind("paused", 0) == 0;
  const std::string troubles = warnings(now);
  const Mood mood = troubles.empty() && !paused ? Mood::kWell : Mood::kAttention;
  std::string text;
  if (find(kLink) == nullptr && !device_) {
    text = "There is a cloth and no exoskeleton: nothing is felt.";
  } else {
    text = feelings();
    text = (mood == Mood::kWell ? "All is well: " : "") + text + ".";
    if (mood != Mood::kWell && !text.empty()) text[0] = static_cast<char>(std::toupper(text[0]));
  }
  if (paused) text += " The cloth is paused.";
  return {mood, text + troubles};
}

std::string SystemStatus::warnings(Time now) const {
  std::string text;
  for (const char* name : {kCloth, kForceLoop, kDriverLoop, kLink}) {
    const Heard* heard = find(name);
    if (heard == nullptr || !isLive(name, now)) continue;
    // That SCHED_FIFO is missing is said by the figures.
    if (heard->diagnosis.level != Diagnosis::Level::kWarn) continue;
    if (heard->diagnosis.message.find("SCHED_FIFO") != std::string::npos) continue;
    text += std::string(" Attention, ") + name + ": " + heard->diagnosis.message + ".";
  }
  return text;
}

std::vector<Figure> SystemStatus::figures(Time now) const {
  std::vector<Figure> figures;
  if (isLive(kCloth, now)) {
    const Diagnosis& cloth = find(kCloth)->diagnosis;
    figures.push_back(
        {"cloth", formatted("%.0f Hz", numberIn(cloth, "step rate (Hz)")) +
                      formatted(", %.2f of real time", numberIn(cloth, "real-time factor"))});
    figures.push_back(
        {"a step", formatted("%.2f ms", numberIn(cloth, "mean computing time of a step (ms)")) +
                       formatted(", at most %.2f",
                                 numberIn(cloth, "largest computing time of a step (ms)"))});
    const std::string budget = valueIn(cloth, "budget (ms)");
    if (!budget.empty()) {
      const double number = numberIn(cloth, "budget (ms)");
      figures.push_back(
          {"budget", number > 0.0 ? formatted("%g ms, kept by ", number) +
                                        formatted("%.0f %% of the steps",
                                                  numberIn(cloth, "cycles within the budget (%)"))
                                  : "none"});
    }
  }
  const std::array<std::pair<const char*, const char*>, 2> loops = {
      {{kForceLoop, "force loop"}, {kDriverLoop, "device loop"}}};
  for (const auto& [name, title] : loops) {
    const Heard* heard = find(name);
    if (heard == nullptr || !isLive(name, now) || !heard->rate) continue;
    const bool fifo = valueIn(heard->diagnosis, "SCHED_FIFO") == "granted";
    figures.push_back({title, formatted("%.0f Hz", *heard->rate) +
                                  formatted(", %.0f missed lately", heard->missed_lately) +
                                  (fifo ? "" : ", no SCHED_FIFO")});
  }
  const Heard* driver = find(kDriverLoop);
  if (driver != nullptr && isLive(kDriverLoop, now)) {
    figures.push_back(
        {"position to force",
         formatted("p50 %.1f", numberIn(driver->diagnosis, "position to force p50 (ms)")) +
             formatted(", p99 %.1f ms",
                       numberIn(driver->diagnosis, "position to force p99 (ms)"))});
  }
  return figures;
}

}  // namespace haptex::nodes
