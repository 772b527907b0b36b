// Constants of nature that several rooms use.
#pragma once

namespace haptex::base {

constexpr double kStandardGravity = 9.80665;  ///< m/s^2, CGPM 1901

}  // namespace haptex::base
