// Replaces malloc of an executable by one that counts. To be included by one source of it.
#pragma once

#include <atomic>
#include <cstddef>

namespace {
std::atomic<long> allocations{0};
[[maybe_unused]] std::atomic<long> allocated_bytes{0};  // asked for, freed or not
}  // namespace

#ifndef __SANITIZE_ADDRESS__  // which brings its own malloc
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  allocated_bytes += static_cast<long>(size);
  return __libc_malloc(size);
}
}
#endif
