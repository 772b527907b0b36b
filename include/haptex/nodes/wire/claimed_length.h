// Whether the arrays of a message have the lengths that its bytes claim, before memory is taken.
#pragma once

#include <ros/serialization.h>

#include <boost/array.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "haptex/base/require.h"

namespace haptex::nodes {

/// Walks the bytes of a message as roscpp's reading does, by the same description of its fields,
/// and keeps nothing. roscpp makes an array as long as its bytes claim and looks only then whether
/// they are there: 14 bytes can ask for gigabytes.
class ClaimedLength {
 public:
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;

  ClaimedLength(const std::uint8_t* bytes, std::uint32_t count) : at_(bytes), left_(count) {}

  /// A field of a message; its value does not count.
  /// @throws std::invalid_argument if the bytes left do not suffice for it
  template <typename Field>
  void next(Field& field) {
    using ros::message_traits::IsSimple;
    if constexpr (IsSimple<Field>::value) {
      skip(sizeof(Field));
    } else {
      ros::serialization::Serializer<Field>::read(*this, field);
    }
  }
  void next(std::string& /*field*/) { skip(claim(1)); }
  void next(ros::Time& /*field*/) { skip(8); }
  void next(ros::Duration& /*field*/) { skip(8); }
  template <typename Item>
  void next(std::vector<Item>& /*field*/) {
    using ros::message_traits::IsFixedSize;
    Item item{};
    if constexpr (IsFixedSize<Item>::value) {
      const std::uint32_t size = ros::serialization::serializationLength(item);
      skip(std::uint64_t{size} * claim(size));
    } else {
      // At least the length of one array or text each.
      const std::uint32_t count = claim(sizeof(std::uint32_t));
      for (std::uint32_t i = 0; i < count; ++i) next(item);
    }
  }
  template <typename Item, std::size_t kSize>
  void next(boost::array<Item, kSize>& field) {
    for (Item& item : field) next(item);
  }

 private:
  void skip(std::uint64_t count) {
    if (count > left_) refuse(count);
    at_ += count;
    left_ -= static_cast<std::uint32_t>(count);
  }

  /// @param size of an item, bytes @returns how many there are
  std::uint32_t claim(std::uint32_t size) {
    std::uint32_t count = 0;
    const std::uint8_t* const at = at_;
    skip(sizeof(count));
    std::memcpy(&count, at, sizeof(count));
    if (std::uint64_t{count} * size > left_) refuse(std::uint64_t{count} * size);
    return count;
  }

  [[noreturn]] void refuse(std::uint64_t claimed) const {
    base::refuse("an array or a text of at least ", claimed, " bytes is claimed: there are ",
                 left_);
  }

  const std::uint8_t* at_;
  std::uint32_t left_;  // bytes
};

/// @throws std::invalid_argument if a message of this type cannot be in the bytes
template <typename Message>
void requireClaimsFit(const std::uint8_t* bytes, std::uint32_t count) {
  Message message;
  ClaimedLength(bytes, count).next(message);
}

}  // namespace haptex::nodes
