#include "haptex/mesh/obj_file.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptex/base/file_size.h"
#include "haptex/base/parse_number.h"
#include "haptex/mesh/merged_seams.h"

namespace haptex::mesh {
namespace {

enum class RestCoordinates { kRequired, kIgnored };

class ObjReader {
 public:
  ObjReader(const std::string& path, RestCoordinates rest_coordinates)
      : path_(path), with_textures_(rest_coordinates == RestCoordinates::kRequired) {}

  ClothMesh read() {
    std::error_code error;
    std::ifstream stream(path_);
    if (!stream.is_open() || std::filesystem::is_directory(path_, error)) {
      throw std::runtime_error(path_ + ": cannot be read, must be a Wavefront OBJ file");
    }
    base::requireFileSize(path_, kLargestObj);  // before a line is held: all of it may be one
    std::string line;
    while (std::getline(stream, line)) {
      ++line_number_;
      readLine(line.substr(0, line.find('#')));
    }
    if (stream.bad()) throw std::runtime_error(path_ + ": cannot be read to its end");
    if (with_textures_) fillRestCoordinates();
    if (seam_) fillPanels();
    return std::move(mesh_);
  }

  MeshGroups groups() { return std::move(groups_); }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(path_ + ": line " + std::to_string(line_number_) + ": " + what);
  }

  void requireRoom(std::size_t held, std::size_t most, const std::string& what) const {
    if (held >= most) refuse("more than " + std::to_string(most) + " " + what);
  }

  void readLine(const std::string& line) {
    std::istringstream words(line);
    std::string statement;
    words >> statement;
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    if (statement == "v") {
      requireRoom(mesh_.initial_positions.size(), 3 * kMostTriangles, "positions");
      mesh_.initial_positions.push_back(readNumbers<3>("v", arguments));
      texture_of_particle_.emplace_back();
    } else if (statement == "vt" && with_textures_) {
      requireRoom(textures_.size(), 3 * kMostTriangles, "texture coordinates");
      textures_.push_back(readNumbers<2>("vt", arguments));
    } else if (statement == "f") {
      readFace(arguments);
    } else if (statement == "g") {
      open_groups_ = std::move(arguments);
    }
  }

  // Further numbers (a weight, a colour) are allowed by the format and mean nothing here.
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> readNumbers(const std::string& statement,
                                              const std::vector<std::string>& words) const {
    Eigen::Matrix<double, kSize, 1> numbers;
    if (words.size() < kSize) {
      refuse("'" + statement + "' has " + std::to_string(words.size()) + " numbers, must have " +
             std::to_string(kSize));
    }
    for (int i = 0; i < kSize; ++i) {
      const std::optional<double> number = base::parseNumber<double>(words[i]);
      if (!number || !std::isfinite(*number)) {
        refuse("number " + std::to_string(i + 1) + " of '" + statement +
               "' must be a finite number");
      }
      numbers[i] = *number;
    }
    return numbers;
  }

  void readFace(const std::vector<std::string>& corners) {
    requireRoom(mesh_.triangles.size(), kMostTriangles, "triangles");
    if (corners.size() != 3) {
      refuse("a face has " + std::to_string(corners.size()) + " corners, must be a triangle");
    }
    std::array<int, 3> triangle, textures{};
    for (int i = 0; i < 3; ++i) textures[i] = readCorner(corners[i], triangle[i]);
    textures_of_triangles_.push_back(textures);
    noteGroups();
    mesh_.triangles.push_back(triangle);
  }

  void noteGroups() {
    const int count = static_cast<int>(std::set(open_groups_.begin(), open_groups_.end()).size());
    if (count != 1 && !outside_) outside_ = Outside{line_number_, count};
    const int next = static_cast<int>(panels_.size());
    group_of_triangles_.push_back(
        count == 1 ? panels_.emplace(open_groups_.front(), next).first->second : -1);
    for (const std::string& group : open_groups_) {
      std::vector<int>& members = groups_[group];
      const int index = static_cast<int>(mesh_.triangles.size());
      if (members.empty() || members.back() != index) members.push_back(index);
    }
  }

  // A corner is position/texture or position/texture/normal, for surfaces also position or
  // position//normal.
  /// @returns its texture coordinate
  int readCorner(const std::string& corner, int& particle) {
    const std::size_t first = corner.find('/');
    particle = readIndex(corner.substr(0, first), "position", mesh_.initial_positions.size());
    return with_textures_ ? readTexture(corner, first, particle) : -1;
  }

  // What follows the first separator of a corner.
  int readTexture(const std::string& corner, std::size_t first, int particle) {
    const std::size_t second =
        first == std::string::npos ? std::string::npos : corner.find('/', first + 1);
    if (first == std::string::npos || first + 1 == corner.size() || second == first + 1) {
      refuse("a corner has no texture coordinate, which is its rest coordinate");
    }
    const int texture = readIndex(corner.substr(first + 1, second - first - 1),
                                  "texture coordinate", textures_.size());
    std::optional<int>& known = texture_of_particle_[particle];
    if (!known) known = texture;
    if (!seam_ && textures_[*known] != textures_[texture]) seam_ = {particle, *known, texture};
    return texture;
  }

  // Counts from 1, or backwards from the last one with -1.
  int readIndex(const std::string& word, const std::string& kind, std::size_t count) const {
    const int size = static_cast<int>(count);
    const std::optional<int> number = base::parseNumber<int>(word);
    if (!number) refuse(kind + " of a corner must be a whole number");
    const int index = *number;
    if (index == 0 || index > size || index < -size) {
      refuse(kind + " " + std::to_string(index) + " does not exist, " + std::to_string(size) +
             " are defined before this line");
    }
    return index > 0 ? index - 1 : size + index;
  }

  // A particle in no face keeps the origin here; requireSound() then reports it.
  void fillRestCoordinates() {
    for (const std::optional<int>& texture : texture_of_particle_) {
      mesh_.rest_coordinates.push_back(texture ? textures_[*texture] : Eigen::Vector2d::Zero());
    }
  }

  // Panels that are sewn together: groups.
  void fillPanels() {
    if (outside_) {
      const auto& [particle, one, other] = *seam_;
      line_number_ = outside_->line;
      refuse("a face is in " + std::to_string(outside_->groups) + " groups ('g'): position " +
             std::to_string(particle + 1) + " has the texture coordinates " +
             std::to_string(one + 1) + " and " + std::to_string(other + 1) +
             " (a seam), so every face must be in one group, its panel");
    }
    mesh_.panels.resize(panels_.size());
    mesh_.triangle_panels = std::move(group_of_triangles_);
    for (const auto& [a, b, c] : textures_of_triangles_) {
      mesh_.corner_coordinates.push_back({textures_[a], textures_[b], textures_[c]});
    }
  }

  struct Outside {
    int line;
    int groups;
  };

  std::string path_;
  bool with_textures_;
  int line_number_ = 0;
  ClothMesh mesh_;
  std::vector<Eigen::Vector2d> textures_;
  std::vector<std::optional<int>> texture_of_particle_;
  std::vector<std::array<int, 3>> textures_of_triangles_;
  std::optional<std::array<int, 3>> seam_;  // the first position with two texture coordinates
  std::vector<std::string> open_groups_;    // of the faces that follow
  MeshGroups groups_;
  std::map<std::string, int> panels_;    // by group, in the order of the file
  std::vector<int> group_of_triangles_;  // in panels_
  std::optional<Outside> outside_;       // the first face that is not in one group
};

}  // namespace

ClothMesh loadObj(const std::string& path) {
  MeshGroups unused;
  return loadObj(path, unused);
}

ClothMesh loadObj(const std::string& path, MeshGroups& groups) {
  ObjReader reader(path, RestCoordinates::kRequired);
  ClothMesh mesh = reader.read();
  groups = reader.groups();
  try {
    requireSound(mesh);
  } catch (const std::invalid_argument& defects) {
    throw std::invalid_argument(path + ": " + defects.what() + " (counted from 0)");
  }
  if (!mesh.corner_coordinates.empty()) addHingesOfMergedSeams(mesh);
  return mesh;
}

ObstacleMesh loadObjSurface(const std::string& path) {
  MeshGroups unused;
  return loadObjSurface(path, unused);
}

ObstacleMesh loadObjSurface(const std::string& path, MeshGroups& groups) {
  ObjReader reader(path, RestCoordinates::kIgnored);
  ClothMesh mesh = reader.read();
  groups = reader.groups();
  if (mesh.triangles.empty()) throw std::invalid_argument(path + ": the mesh has no triangle");
  return {std::move(mesh.initial_positions), std::move(mesh.triangles)};
}

}  // namespace haptex::mesh
