#include "haptex/serial/link_status.h"

namespace haptex::serial {

const char* describe(LinkStatus status) {
  switch (status) {
    case LinkStatus::kConnecting:
      return "the device has not answered yet";
    case LinkStatus::kConnected:
      return "connected to the device";
    case LinkStatus::kTimedOut:
      return "the device has stopped sending states";
    case LinkStatus::kVersionMismatch:
      return "the device speaks another version of the protocol";
  }
  return "unknown";
}

}  // namespace haptex::serial
