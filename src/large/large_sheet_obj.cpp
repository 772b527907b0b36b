// A large sheet as an OBJ file.
#include <petscsys.h>

#include <ostream>

#include "haptex/large/large_sheet.h"
#include "haptex/mesh/obj_writer.h"

namespace haptex::large {
namespace {

constexpr int kTag = 1;  // of messages with positions

void writeRest(const Sheet& sheet, std::ostream& out) {
  for (int row = 0; row < sheet.rowCount(); ++row) {
    for (int column = 0; column < sheet.rowSize(); ++column) {
      out << "vt " << sheet.width * column / sheet.cells_u << ' '
          << sheet.height * row / sheet.cells_v << '\n';
    }
  }
}

/// Two rows of cells at a time, as diagonals repeat.
void writeTriangles(const Sheet& sheet, std::ostream& out) {
  const mesh::ClothMesh pair = mesh::makeRectangle(1.0, 1.0, sheet.cells_u, 2, sheet.triangulation);
  for (int row = 0; row < sheet.cells_v; row += 2) {
    const std::int64_t first = 1 + std::int64_t{row} * sheet.rowSize();
    const std::size_t count = pair.triangles.size() / (row + 1 < sheet.cells_v ? 1 : 2);
    for (std::size_t t = 0; t < count; ++t) {
      out << 'f';
      for (const int corner : pair.triangles[t]) {
        out << ' ' << first + corner << '/' << first + corner;
      }
      out << '\n';
    }
  }
}

}  // namespace

void LargeSheet::writeObj(std::ostream& out) const {
  const auto begin = strip_.state().positions.begin();
  std::vector<Eigen::Vector3d> positions(begin + place_.own_begin, begin + place_.own_end);
  if (part_ > 0) {
    MPI_Send(positions.data(), static_cast<int>(3 * positions.size()), MPI_DOUBLE, 0, kTag,
             PETSC_COMM_WORLD);
    return;
  }
  mesh::writeObjPositions(positions, out);
  for (int part = 1; part < parts_; ++part) {
    const PartPlace place = placeOf(sheet_, part, parts_);
    positions.resize(place.own_end - place.own_begin);
    MPI_Recv(positions.data(), static_cast<int>(3 * positions.size()), MPI_DOUBLE, part, kTag,
             PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
    mesh::writeObjPositions(positions, out);
  }
  writeRest(sheet_, out);
  writeTriangles(sheet_, out);
}

}  // namespace haptex::large
