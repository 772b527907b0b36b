#include "haptex/serial/firmware_link.h"

namespace haptex::serial {

void FirmwareLink::greet(const Frame& frame) {
  const auto hello = decodeHello(frame);
  if (!hello) return;
  to_answer_ = true;
  if (hello->version != version_) return;
  greeted_ = true;
  command_number_ = frame.sequence;
}

int FirmwareLink::commandsAhead(std::uint8_t number) const {
  if (!greeted_) return 0;
  // After a Hello the command of a dead driver may still come twice, with a number that looks new.
  if (has_obeyed_ && number == obeyed_number_) return 0;
  return numbersAhead(number, command_number_);
}

}  // namespace haptex::serial
