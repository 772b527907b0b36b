#include "haptex/contact/panel_kernels.h"

#include <cstddef>

namespace haptex::contact {
namespace {

template <int kBytes>
struct Lanes {
  static constexpr int kCount = kBytes / static_cast<int>(sizeof(float));
  typedef float Type __attribute__((vector_size(kBytes)));
  /// At any address. A struct, because Clang forgets the alignment of a vector type in a template.
  struct [[gnu::packed, gnu::may_alias]] Memory {
    Type lanes;
  };
};

template <int kBytes>
[[gnu::always_inline]] inline typename Lanes<kBytes>::Memory& at(float* address) {
  return *reinterpret_cast<typename Lanes<kBytes>::Memory*>(address);
}

template <int kBytes>
[[gnu::always_inline]] inline const typename Lanes<kBytes>::Memory& at(const float* address) {
  return *reinterpret_cast<const typename Lanes<kBytes>::Memory*>(address);
}

template <int kBytes, int kVectors>
[[gnu::always_inline]] inline void multiplyRows(int leading, int columns, const float* panel,
                                                const float* x, float* y) {
  constexpr int kCount = Lanes<kBytes>::kCount;
  typename Lanes<kBytes>::Type sum[kVectors] = {};
  for (int c = 0; c < columns; ++c, panel += leading) {
    for (int v = 0; v < kVectors; ++v) sum[v] += at<kBytes>(panel + v * kCount).lanes * x[c];
  }
  for (int v = 0; v < kVectors; ++v) at<kBytes>(y + v * kCount).lanes = sum[v];
}

template <int kBytes>
[[gnu::always_inline]] inline void multiplyOf(int leading, int columns, const float* panel,
                                              const float* x, float* y) {
  constexpr int kCount = Lanes<kBytes>::kCount;
  int r = 0;
  for (; r + 4 * kCount <= leading; r += 4 * kCount) {
    multiplyRows<kBytes, 4>(leading, columns, panel + r, x, y + r);
  }
  for (; r + 2 * kCount <= leading; r += 2 * kCount) {
    multiplyRows<kBytes, 2>(leading, columns, panel + r, x, y + r);
  }
  for (; r < leading; r += kCount) multiplyRows<kBytes, 1>(leading, columns, panel + r, x, y + r);
}

/// The sum of all lanes, halves first.
template <int kBytes>
[[gnu::always_inline]] inline float sumOf(const typename Lanes<kBytes>::Type& lanes) {
  if constexpr (kBytes == 8) {
    return lanes[0] + lanes[1];
  } else {
    union Halves {
      typename Lanes<kBytes>::Type whole;
      typename Lanes<kBytes / 2>::Type half[2];
    };
    const Halves halves{lanes};
    return sumOf<kBytes / 2>(halves.half[0] + halves.half[1]);
  }
}

template <int kBytes>
[[gnu::always_inline]] inline void multiplyTransposedOf(int leading, int columns,
                                                        const float* panel, const float* y,
                                                        float* x) {
  constexpr int kCount = Lanes<kBytes>::kCount;
  const std::ptrdiff_t next = leading;
  for (int c = 0; c < columns; c += 3, panel += 3 * next) {
    typename Lanes<kBytes>::Type sum[3] = {};
    for (int r = 0; r < leading; r += kCount) {
      const auto values = at<kBytes>(y + r).lanes;
      for (int i = 0; i < 3; ++i) sum[i] += at<kBytes>(panel + i * next + r).lanes * values;
    }
    for (int i = 0; i < 3; ++i) x[c + i] = sumOf<kBytes>(sum[i]);
  }
}

struct Kernels {
  void (*multiply)(int, int, const float*, const float*, float*);
  void (*multiply_transposed)(int, int, const float*, const float*, float*);
};

// One class per instruction set, because a template cannot be given the attribute.
#define HAPTEX_PANEL_KERNELS(Name, kBytes, ...)                                                    \
  struct Name {                                                                                    \
    __VA_ARGS__ static void multiply(int leading, int columns, const float* panel, const float* x, \
                                     float* y) {                                                   \
      multiplyOf<kBytes>(leading, columns, panel, x, y);                                           \
    }                                                                                              \
    __VA_ARGS__ static void multiplyTransposed(int leading, int columns, const float* panel,       \
                                               const float* y, float* x) {                         \
      multiplyTransposedOf<kBytes>(leading, columns, panel, y, x);                                 \
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
