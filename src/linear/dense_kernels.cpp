#include "haptex/linear/dense_kernels.h"

#include <initializer_list>
#include <type_traits>

#include "haptex/linear/dense_kernels_avx512.h"
#include "haptex/linear/register_kernels.h"

namespace haptex::linear {
namespace {

// One class per instruction set, because a template cannot be given the attribute.
#define HAPTEX_DENSE_KERNELS(Name, kBytes, ...)                                                    \
  template <typename T>                                                                            \
  struct Name {                                                                                    \
    using R = registers::Register<T, kBytes>;                                                      \
    __VA_ARGS__ static void subtractProduct(int rows, int columns, int depth, const T* a, int lda, \
                                            const T* b, int ldb, T* c, int ldc) {                  \
      registers::subtractProductOf<R>(rows, columns, depth, a, lda, b, ldb, c, ldc);               \
    }                                                                                              \
    __VA_ARGS__ static void multiply(int rows, int columns, int depth, const T* a, int lda,        \
                                     const T* b, int ldb, T* c, int ldc) {                         \
      registers::multiplyOf<R>(rows, columns, depth, a, lda, b, ldb, c, ldc);                      \
    }                                                                                              \
    __VA_ARGS__ static void subtractRuns(const RowRun* runs, int run_count, const T* a, int lda,   \
                                         T* c, int ldc) {                                          \
      registers::subtractRunsOf<R>(runs, run_count, a, lda, c, ldc);                               \
    }                                                                                              \
    __VA_ARGS__ static void divideThreeColumns(int rows, const T* top, int ldtop, T* a, int lda) { \
      registers::divideThreeColumnsOf<R>(rows, top, ldtop, a, lda);                                \
    }                                                                                              \
    __VA_ARGS__ static bool factoriseThreeColumns(int rows, T* a, int lda) {                       \
      return registers::factoriseThreeColumnsOf<R>(rows, a, lda);                                  \
    }                                                                                              \
    __VA_ARGS__ static void substituteForward(int rows, int columns, const T* l, int ldl, T* x) {  \
      registers::substituteForwardOf<R>(rows, columns, l, ldl, x);                                 \
    }                                                                                              \
    __VA_ARGS__ static void substituteBackward(int rows, int columns, const T* l, int ldl, T* x) { \
      registers::substituteBackwardOf<R>(rows, columns, l, ldl, x);                                \
    }                                                                                              \
    static constexpr DenseKernels<T> kKernels{                                                     \
        subtractProduct,       multiply,          subtractRuns,      divideThreeColumns,           \
        factoriseThreeColumns, substituteForward, substituteBackward};                             \
  };

HAPTEX_DENSE_KERNELS(Baseline, 32, )
#if defined(__x86_64__)
HAPTEX_DENSE_KERNELS(Avx2, 32, [[gnu::target("avx2,fma")]])
#endif
#undef HAPTEX_DENSE_KERNELS

#if defined(__x86_64__)
// The panels of small systems, which are those in double precision, are too short for it.
constexpr DenseKernels<float> kAvx512Kernels{
    avx512::subtractProduct,       avx512::multiply,
    avx512::subtractRuns,          avx512::divideThreeColumns,
    avx512::factoriseThreeColumns, avx512::substituteForward,
    avx512::substituteBackward};
#endif

template <typename T>
const DenseKernels<T>& kernels() {
  static const DenseKernels<T>& best = []() -> const DenseKernels<T>& {
    for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2}) {
      if (const DenseKernels<T>* const kernels = denseKernels<T>(set)) return *kernels;
    }
    return Baseline<T>::kKernels;
  }();
  return best;
}

}  // namespace

template <typename T>
const DenseKernels<T>* denseKernels(InstructionSet set) {
  if (set == InstructionSet::kBaseline) return &Baseline<T>::kKernels;
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return nullptr;
  if (set == InstructionSet::kAvx2) return &Avx2<T>::kKernels;
  if constexpr (std::is_same_v<T, float>) {
    if (__builtin_cpu_supports("avx512f")) return &kAvx512Kernels;
  }
#endif
  return nullptr;
}

template <typename T>
void subtractProduct(int rows, int columns, int depth, const T* a, int lda, const T* b, int ldb,
                     T* c, int ldc) {
  kernels<T>().subtract_product(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

template <typename T>
void multiply(int rows, int columns, int depth, const T* a, int lda, const T* b, int ldb, T* c,
              int ldc) {
  kernels<T>().multiply(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

template <typename T>
void subtractRuns(const RowRun* runs, int run_count, const T* a, int lda, T* c, int ldc) {
  kernels<T>().subtract_runs(runs, run_count, a, lda, c, ldc);
}

template <typename T>
void divideThreeColumns(int rows, const T* top, int ldtop, T* a, int lda) {
  kernels<T>().divide_three_columns(rows, top, ldtop, a, lda);
}

template <typename T>
bool factoriseThreeColumns(int rows, T* a, int lda) {
  return kernels<T>().factorise_three_columns(rows, a, lda);
}

template <typename T>
void substituteForward(int rows, int columns, const T* l, int ldl, T* x) {
  kernels<T>().substitute_forward(rows, columns, l, ldl, x);
}

template <typename T>
void substituteBackward(int rows, int columns, const T* l, int ldl, T* x) {
  kernels<T>().substitute_backward(rows, columns, l, ldl, x);
}

#define HAPTEX_INSTANTIATE(T)                                                          \
  template const DenseKernels<T>* denseKernels(InstructionSet);                        \
  template void subtractProduct(int, int, int, const T*, int, const T*, int, T*, int); \
  template void multiply(int, int, int, const T*, int, const T*, int, T*, int);        \
  template void subtractRuns(const RowRun*, int, const T*, int, T*, int);              \
  template void divideThreeColumns(int, const T*, int, T*, int);                       \
  template bool factoriseThreeColumns(int, T*, int);                                   \
  template void substituteForward(int, int, const T*, int, T*);                        \
  template void substituteBackward(int, int, const T*, int, T*);

HAPTEX_INSTANTIATE(double)
HAPTEX_INSTANTIATE(float)
#undef HAPTEX_INSTANTIATE

}  // namespace haptex::linear
