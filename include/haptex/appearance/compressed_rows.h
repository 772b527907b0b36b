// Large matrices by their principal components, of all rows together and of clusters of rows.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace haptex::appearance {

struct Compression {
  static constexpr int kMaxComponents = 256, kMaxClusters = 256;

  int components;  ///< of all rows together, 1 to kMaxComponents
  int clusters;    ///< 1 to kMaxClusters; with 1 there are no others than these components
  int local;       ///< components of each cluster, 1 to `components`
};

/// A matrix, row i of which is about mean + basis^T (offset_c + axes_c q_i), c being the cluster of
/// the row and q_i its coefficients: whole numbers of 16 bits times a scale.
struct CompressedRows {
  Compression size;
  Eigen::VectorXf mean;                ///< by column of the matrix
  Eigen::MatrixXf basis;               ///< components x columns, its rows orthonormal or zero
  std::vector<std::uint8_t> clusters;  ///< by row
  Eigen::MatrixXf offsets;             ///< components x clusters
  Eigen::MatrixXf axes;                ///< components x (clusters local), cluster by cluster
  Eigen::MatrixXf scales;              ///< local x clusters
  Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic> coefficients;  ///< local x rows

  int rows() const { return static_cast<int>(clusters.size()); }
  int columns() const { return static_cast<int>(mean.size()); }
  /// In the basis, of a row: the row is about mean + basis^T coordinates.
  Eigen::VectorXf coordinates(int row) const;
  /// That the numbers take.
  std::size_t bytes() const;
};

/// Writes the values of a row, as many as the matrix has columns. Called several times for some.
using RowSource = std::function<void(int row, float* values)>;

/// The matrix is never held: the basis is that of kSubset rows, spread over all (all if there are
/// fewer), by the eigenvectors of their Gram matrix, and every row is then projected on it, one
/// after the other. Clusters are those of k-means of the projections, and their axes the principal
/// ones of the projections in each. The same rows give the same result at every call.
/// @param rows, columns of the matrix, at least 1
/// @throws std::invalid_argument naming a number of `size` that is not allowed
CompressedRows compressRows(int rows, int columns, const RowSource& source,
                            const Compression& size);
constexpr int kSubset = 512;

/// @throws std::invalid_argument naming a number that is not allowed
void requireSound(const Compression& size);

}  // namespace haptex::appearance
