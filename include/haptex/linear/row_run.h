// Rows that the updates of a factorisation move from matrix to matrix.
#pragma once

namespace haptex::linear {

/// Rows that follow each other in two matrices.
struct RowRun {
  int from;   // first row where they are read
  int to;     // first row where they are changed
  int count;  // > 0
};

}  // namespace haptex::linear
