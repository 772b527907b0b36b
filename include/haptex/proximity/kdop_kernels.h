// Inner loops of KdopHierarchy, compiled for several instruction sets.
#pragma once

namespace haptex::proximity {

enum class InstructionSet {
  kBaseline,  ///< what every processor of the platform has
  kAvx2,      ///< x86-64 with AVX2 and FMA
};

/// The best that this processor has.
InstructionSet bestInstructionSet();

}  // namespace haptex::proximity
