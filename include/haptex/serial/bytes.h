// A view of bytes that somebody else owns.
#pragma once

#include <cstddef>
#include <cstdint>

namespace haptex::serial {

struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  bool empty() const { return size == 0; }
};

}  // namespace haptex::serial
