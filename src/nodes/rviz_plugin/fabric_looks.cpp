#include "haptex/nodes/rviz_plugin/fabric_looks.h"

#include <algorithm>
#include <exception>

#include "haptex/appearance/btf_file.h"

namespace haptex::nodes {
namespace {

FabricLooks::Look lookOf(const std::string& path) {
  try {
    return {
        std::make_shared<appearance::Brdf>(appearance::meanOverRepeat(appearance::readBtf(path))),
        ""};
  } catch (const std::exception& error) {
    return {nullptr, error.what()};
  }
}

bool isOpen(const FabricLooks::Look& look) { return !look.brdf && look.error.empty(); }

}  // namespace

FabricLooks::~FabricLooks() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  asked_.notify_one();
  if (reader_.joinable()) reader_.join();
}

FabricLooks::Look FabricLooks::of(const std::string& path) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<Look>& look = looks_[path];
  if (!look) {
    look = std::make_shared<Look>();
    if (!reader_.joinable()) reader_ = std::thread([this] { read(); });
    asked_.notify_one();
  }
  return *look;
}

void FabricLooks::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  looks_.clear();
}

void FabricLooks::read() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_ending_) {
    const auto next = std::find_if(looks_.begin(), looks_.end(),
                                   [](const auto& look) { return isOpen(*look.second); });
    if (next == looks_.end()) {
      asked_.wait(lock);
      continue;
    }
    const auto [path, asked] = *next;  // which forget() may take out meanwhile
    lock.unlock();
    const Look look = lookOf(path);
    lock.lock();
    *asked = look;
  }
}

}  // namespace haptex::nodes
