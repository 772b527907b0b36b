#include "haptex/nodes/rviz_plugin/service_calls.h"

#include <iterator>
#include <thread>
#include <utility>

#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

bool ServiceCalls::run(const std::string& service, std::function<Answer()> work) {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    if (!shared_->begun.emplace(service, realtime::steadyNow()).second) return false;
  }
  std::thread([shared = shared_, service, work = std::move(work)] {
    Answer answer = work();
    const std::lock_guard<std::mutex> lock(shared->mutex);
    shared->begun.erase(service);
    shared->answers.push_back(std::move(answer));
  }).detach();
  return true;
}

std::vector<Answer> ServiceCalls::answers() {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  std::vector<Answer> answers(std::make_move_iterator(shared_->answers.begin()),
                              std::make_move_iterator(shared_->answers.end()));
  shared_->answers.clear();
  return answers;
}

std::string ServiceCalls::waiting() const {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  const base::Time now = realtime::steadyNow();
  std::string names;
  for (const auto& [service, begun] : shared_->begun) {
    if (now - begun > kPatience) names += (names.empty() ? "" : ", ") + service;
  }
  return names.empty() ? "" : "no answer yet from " + names;
}

}  // namespace haptex::nodes
