// Bytes that the tests of serial lines share.
#pragma once

#include <cstdint>
#include <vector>

#include "haptex/serial/bytes.h"

namespace haptex::serial {

using ByteVector = std::vector<std::uint8_t>;

inline ByteVector copy(Bytes bytes) { return ByteVector(bytes.data, bytes.data + bytes.size); }
inline Bytes view(const ByteVector& bytes) { return {bytes.data(), bytes.size()}; }

inline void append(ByteVector& to, const ByteVector& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace haptex::serial
