// Replaces malloc of an executable by one that counts. To be included by one source of it.
#pragma once

#include <atomic>
#include <cstddef>

namespace {
std::atomic<long> allocations{0};
}

#ifndef __SANITIZE_ADDRESS__  // which brings its own malloc
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif
