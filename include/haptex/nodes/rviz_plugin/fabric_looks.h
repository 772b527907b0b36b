// What fabrics look like from afar, for a graphical program, which must not wait for it.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "haptex/appearance/brdf.h"

namespace haptex::nodes {

/// Reads files of fabric_btf on a thread of its own, one after another, and keeps their means over
/// the repeat.
class FabricLooks {
 public:
  struct Look {
    std::shared_ptr<const appearance::Brdf> brdf;  ///< none while the file is being read
    std::string error;                             ///< why there will be none
  };

  FabricLooks() = default;
  /// Waits for the file that is being read, up to two seconds.
  ~FabricLooks();
  FabricLooks(const FabricLooks&) = delete;
  FabricLooks& operator=(const FabricLooks&) = delete;

  /// What is known of a file, which is read if it was not asked for before. Waits for nothing.
  Look of(const std::string& path);
  /// Files are read anew when they are asked for again.
  void forget();

 private:
  void read();

  std::mutex mutex_;  // of the next three
  std::condition_variable asked_;
  std::map<std::string, std::shared_ptr<Look>> looks_;  // by path
  bool is_ending_ = false;
  std::thread reader_;  // from the first file on
};

}  // namespace haptex::nodes
