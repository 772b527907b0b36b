// Files of states of a cloth, which scenes can start from.
#pragma once

#include <cstddef>
#include <string>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::scene {

inline const std::string kStateExtension = ".state";
/// Bytes that loadState() reads at most: about twice those of the largest cloth of a scene.
constexpr std::size_t kLargestStateFile = std::size_t{128} << 20;

/// Writes time, positions and velocities; docs/scene_files.md describes the format. Numbers are
/// read back to the last bit. What is at the path is replaced, by one that is complete: after a
/// failure it is still there. By any thread.
/// @param path absolute, ending with kStateExtension
/// @throws std::invalid_argument if the path is not, or a number is one that loadState() refuses
/// @throws std::runtime_error naming path and reason if it cannot be written
void saveState(const std::string& path, const cloth::ClothState& state);

/// @returns without what forces remember
/// @throws std::runtime_error naming the path if it cannot be read or is larger than
///   kLargestStateFile
/// @throws std::invalid_argument naming path, line and what is allowed: a number is not finite or
///   beyond proximity::kMaxLength, the time is negative, there are not as many particles as the
///   file says, or it is no such file
cloth::ClothState loadState(const std::string& path);

}  // namespace haptex::scene
