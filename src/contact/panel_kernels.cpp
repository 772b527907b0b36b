#include "haptex/contact/panel_kernels.h"

#include <cstddef>

#include "haptex/linear/register_kernels.h"

namespace haptex::contact {
namespace {

using linear::registers::at;

template <typename R, int kVectors>
[[gnu::always_inline]] inline void multiplyRows(int leading, int columns, const float* panel,
                                                const float* x, float* y) {
  typename R::Lanes sum[kVectors] = {};
  for (int c = 0; c < columns; ++c, panel += leading) {
    for (int v = 0; v < kVectors; ++v) sum[v] += at<R>(panel + v * R::kLanes).lanes * x[c];
  }
  for (int v = 0; v < kVectors; ++v) at<R>(y + v * R::kLanes).lanes = sum[v];
}

template <typename R>
[[gnu::always_inline]] inline void multiplyOf(int leading, int columns, const float* panel,
                                              const float* x, float* y) {
  int r = 0;
  for (; r + 4 * R::kLanes <= leading; r += 4 * R::kLanes) {
    multiplyRows<R, 4>(leading, columns, panel + r, x, y + r);
  }
  for (; r + 2 * R::kLanes <= leading; r += 2 * R::kLanes) {
    multiplyRows<R, 2>(leading, columns, panel + r, x, y + r);
  }
  for (; r < leading; r += R::kLanes) multiplyRows<R, 1>(leading, columns, panel + r, x, y + r);
}

/// The sum of all lanes, halves first.
template <typename R>
[[gnu::always_inline]] inline float sumOf(const typename R::Lanes& lanes) {
  if constexpr (R::kLanes == 2) {
    return lanes[0] + lanes[1];
  } else {
    union Halves {
      typename R::Lanes whole;
      typename R::Half::Lanes half[2];
    };
    const Halves halves{lanes};
    return sumOf<typename R::Half>(halves.half[0] + halves.half[1]);
  }
}

template <typename R>
[[gnu::always_inline]] inline void multiplyTransposedOf(int leading, int columns,
                                                        const float* panel, const float* y,
                                                        float* x) {
  const std::ptrdiff_t next = leading;
  for (int c = 0; c < columns; c += 3, panel += 3 * next) {
    typename R::Lanes sum[3] = {};
    for (int r = 0; r < leading; r += R::kLanes) {
      const auto values = at<R>(y + r).lanes;
      for (int i = 0; i < 3; ++i) sum[i] += at<R>(panel + i * next + r).lanes * values;
    }
    for (int i = 0; i < 3; ++i) x[c + i] = sumOf<R>(sum[i]);
  }
}

struct Kernels {
  void (*multiply)(int, int, const float*, const float*, float*);
  void (*multiply_transposed)(int, int, const float*, const float*, float*);
};

// One class per instruction set, because a template cannot be given the attribute.
#define HAPTEX_PANEL_KERNELS(Name, kBytes, ...)                                                    \
  struct Name {                                                                                    \
    using R = linear::registers::Register<float, kBytes>;                                          \
    __VA_ARGS__ static void multiply(int leading, int columns, const float* panel, const float* x, \
                                     float* y) {                                                   \
      multiplyOf<R>(leading, columns, panel, x, y);                                                \
    }                                                                                              \
    __VA_ARGS__ static void multiplyTransposed(int leading, int columns, const float* panel,       \
                                               const float* y, float* x) {                         \
      multiplyTransposedOf<R>(leading, columns, panel, y, x);                                      \
    }                                                                                              \
    static constexpr Kernels kKernels{multiply, multiplyTransposed};                               \
  };

HAPTEX_PANEL_KERNELS(Baseline, 16, )
#if defined(__x86_64__)
HAPTEX_PANEL_KERNELS(Avx2, 32, [[gnu::target("avx2,fma")]])
HAPTEX_PANEL_KERNELS(Avx512, 64, [[gnu::target("avx512f,avx2,fma")]])
#endif
#undef HAPTEX_PANEL_KERNELS

const Kernels& kernels() {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  static const bool widest = wide && __builtin_cpu_supports("avx512f");
  if (widest) return Avx512::kKernels;
  if (wide) return Avx2::kKernels;
#endif
  return Baseline::kKernels;
}

}  // namespace

void multiplyPanel(int leading, int columns, const float* panel, const float* x, float* y) {
  kernels().multiply(leading, columns, panel, x, y);
}

void multiplyTransposed(int leading, int columns, const float* panel, const float* y, float* x) {
  kernels().multiply_transposed(leading, columns, panel, y, x);
}

}  // namespace haptex::contact
