// Fabric files made of readings.
#pragma once

#include <iosfwd>

#include "haptex/material/tester_fabric.h"

namespace haptex::material {

/// Writes a fabric file that loadFabric() reads, numbers to twelve digits; docs/fabric_files.md
/// describes the format. What has no key there are comments.
void writeFabric(const TesterFabric& fabric, std::ostream& out);

}  // namespace haptex::material
