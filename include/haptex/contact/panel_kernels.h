// Products of a tall dense panel and its transpose with vectors, compiled for several instruction
// sets, of which the widest that the processor has is taken.
#pragma once

namespace haptex::contact {

/// Panels are column-major in single precision; the distance between columns, `leading`, is a
/// multiple of this, and so is the length of vectors with one number per row.
constexpr int kPanelLanes = 16;

/// y = P x. @param x one number per column
void multiplyPanel(int leading, int columns, const float* panel, const float* x, float* y);

/// x = P^T y. @param columns a multiple of 3
void multiplyTransposed(int leading, int columns, const float* panel, const float* y, float* x);

}  // namespace haptex::contact
