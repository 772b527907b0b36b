// A linear system in a file, for solvers that are programs of their own.
#pragma once

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptex::bench {

/// Blocks of 3x3 by rows, both triangles; three numbers of the rest for each block row.
struct DumpedSystem {
  std::vector<int> begin;         // of block rows in columns, and the end
  std::vector<int> columns;       // block columns
  std::vector<double> blocks;     // nine numbers each, rows first
  std::vector<double> rhs;        // three numbers each
  std::vector<double> positions;  // m, likewise
};

/// @throws std::runtime_error naming the file if it cannot be written
inline void writeSystem(const DumpedSystem& system, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  const auto write = [&](const auto& values) {
    const std::size_t count = values.size();
    file.write(reinterpret_cast<const char*>(&count), sizeof(count));
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(count * sizeof(values[0])));
  };
  write(system.begin);
  write(system.columns);
  write(system.blocks);
  write(system.rhs);
  write(system.positions);
  file.close();
  if (!file) throw std::runtime_error(path + " cannot be written");
}

/// Of writeSystem() on this machine. @throws std::runtime_error naming the file if it is not whole
inline DumpedSystem readSystem(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  DumpedSystem system;
  const auto read = [&](auto& values) {
    std::size_t count = 0;
    file.read(reinterpret_cast<char*>(&count), sizeof(count));
    if (!file) throw std::runtime_error(path + " cannot be read");
    values.resize(count);
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(count * sizeof(values[0])));
  };
  read(system.begin);
  read(system.columns);
  read(system.blocks);
  read(system.rhs);
  read(system.positions);
  if (!file) throw std::runtime_error(path + " ends too early");
  return system;
}

}  // namespace haptex::bench
