// How much the studies look at in a build with sanitizers.
#pragma once

namespace haptex::base {

/// Whether the sanitizers of addresses or threads watch: everything takes thirty times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// A number of cells, cases or steps: with sanitizers fewer, enough to run every line. How exact
/// the result is, the release build shows.
template <typename Number>
constexpr Number unlessSanitized(Number full, Number shortened) {
  return kSanitized ? shortened : full;
}

}  // namespace haptex::base
