#include "haptex/appearance/compressed_rows.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/base/repeatable_random.h"
#include "haptex/base/require.h"

namespace haptex::appearance {
namespace {

using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;
using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kBlock = 64;  // rows that are projected together
constexpr int kLloydSteps = 30;
constexpr float kLargest = 32767.0f;
constexpr double kNoise = 1e-9;  // eigenvalues, relative: less is rounding of floats

/// So many different ones of all rows, spread evenly, each at random within its part.
std::vector<int> spread(int rows, int count) {
  base::RepeatableRandom random(1);
  std::vector<int> chosen;
  for (int i = 0; i < count; ++i) {
    const int first = static_cast<int>(static_cast<long>(rows) * i / count);
    const int next = static_cast<int>(static_cast<long>(rows) * (i + 1) / count);
    chosen.push_back(first + random.below(next - first));
  }
  return chosen;
}

void findBasis(int rows, int columns, const RowSource& source, CompressedRows& compressed) {
  const std::vector<int> chosen = spread(rows, std::min(rows, kSubset));
  RowMajor subset(chosen.size(), columns);
  for (std::size_t i = 0; i < chosen.size(); ++i) source(chosen[i], subset.row(i).data());
  compressed.mean = subset.colwise().mean();
  subset.rowwise() -= compressed.mean.transpose();
  MatrixXf gram = MatrixXf::Zero(subset.rows(), subset.rows());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(subset);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(gram.cast<double>());
  const VectorXd& values = solved.eigenvalues();
  compressed.basis = MatrixXf::Zero(compressed.size.components, columns);
  for (int i = 0; i < std::min<int>(compressed.size.components, values.size()); ++i) {
    const Eigen::Index from_end = values.size() - 1 - i;
    if (!(values[from_end] > kNoise * values[values.size() - 1])) break;
    const VectorXf weights =
        (solved.eigenvectors().col(from_end) / std::sqrt(values[from_end])).cast<float>();
    compressed.basis.row(i).noalias() = weights.transpose() * subset;
  }
}

/// @returns components x rows
MatrixXf project(int rows, const RowSource& source, const CompressedRows& compressed) {
  MatrixXf projected(compressed.size.components, rows);
  RowMajor block(kBlock, compressed.columns());
  for (int first = 0; first < rows; first += kBlock) {
    const int count = std::min(kBlock, rows - first);
    for (int i = 0; i < count; ++i) source(first + i, block.row(i).data());
    block.topRows(count).rowwise() -= compressed.mean.transpose();
    projected.middleCols(first, count).noalias() =
        compressed.basis * block.topRows(count).transpose();
  }
  return projected;
}

/// k-means by Lloyd's iteration from centres among the points, each as far as possible from those
/// before it.
void findClusters(const MatrixXf& points, CompressedRows& compressed) {
  const int count = compressed.size.clusters;
  MatrixXf& centres = compressed.offsets;
  centres = MatrixXf::Zero(points.rows(), count);
  compressed.clusters.assign(points.cols(), 0);
  centres.col(0) = points.rowwise().mean();
  VectorXf nearest = VectorXf::Constant(points.cols(), std::numeric_limits<float>::max());
  for (int i = 1; i < count; ++i) {
    nearest = nearest.cwiseMin(
        (points.colwise() - centres.col(i - 1)).colwise().squaredNorm().transpose());
    Eigen::Index farthest;
    nearest.maxCoeff(&farthest);
    centres.col(i) = points.col(farthest);
  }
  for (int step = 0; count > 1 && step < kLloydSteps; ++step) {
    MatrixXf sums = MatrixXf::Zero(points.rows(), count);
    VectorXf members = VectorXf::Zero(count);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      Eigen::Index best;
      (centres.colwise() - points.col(i)).colwise().squaredNorm().minCoeff(&best);
      compressed.clusters[i] = static_cast<std::uint8_t>(best);
      sums.col(best) += points.col(i);
      members[best] += 1.0f;
    }
    for (int c = 0; c < count; ++c) {
      if (members[c] > 0.0f) centres.col(c) = sums.col(c) / members[c];
    }
  }
}

/// The principal axes of the points of every cluster, and the points by them.
void findAxes(const MatrixXf& points, CompressedRows& compressed) {
  const auto& [components, clusters, local] = compressed.size;
  compressed.axes = MatrixXf::Zero(components, clusters * local);
  compressed.scales = MatrixXf::Zero(local, clusters);
  compressed.coefficients.resize(local, points.cols());
  for (int c = 0; c < clusters; ++c) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(components, components);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (compressed.clusters[i] != c) continue;
      const VectorXd away = (points.col(i) - compressed.offsets.col(c)).cast<double>();
      covariance.selfadjointView<Eigen::Lower>().rankUpdate(away);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(covariance);
    auto axes = compressed.axes.middleCols(c * local, local);
    axes = solved.eigenvectors().rightCols(local).rowwise().reverse().cast<float>();
  }
  MatrixXf exact(local, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const int c = compressed.clusters[i];
    exact.col(i) = compressed.axes.middleCols(c * local, local).transpose() *
                   (points.col(i) - compressed.offsets.col(c));
    compressed.scales.col(c) =
        compressed.scales.col(c).cwiseMax(exact.col(i).cwiseAbs() / kLargest);
  }
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto scales = compressed.scales.col(compressed.clusters[i]);
    for (int k = 0; k < local; ++k) {
      compressed.coefficients(k, i) =
          static_cast<std::int16_t>(scales[k] > 0.0f ? std::lround(exact(k, i) / scales[k]) : 0);
    }
  }
}

}  // namespace

VectorXf CompressedRows::coordinates(int row) const {
  const int c = clusters[row];
  return offsets.col(c) +
         axes.middleCols(c * size.local, size.local) *
             (coefficients.col(row).cast<float>().cwiseProduct(scales.col(c))).matrix();
}

std::size_t CompressedRows::bytes() const {
  const auto floats = mean.size() + basis.size() + offsets.size() + axes.size() + scales.size();
  return 4 * floats + clusters.size() + 2 * coefficients.size();
}

void requireSound(const Compression& size) {
  const auto require_count = [](const char* name, int count, int largest) {
    if (count >= 1 && count <= largest) return;
    base::refuse("the compression has ", count, " ", name, ": allowed are 1 to ", largest);
  };
  require_count("components", size.components, Compression::kMaxComponents);
  require_count("clusters", size.clusters, Compression::kMaxClusters);
  require_count("local components", size.local, size.components);
}

CompressedRows compressRows(int rows, int columns, const RowSource& source,
                            const Compression& size) {
  requireSound(size);
  CompressedRows compressed;
  compressed.size = size;
  findBasis(rows, columns, source, compressed);
  const MatrixXf points = project(rows, source, compressed);
  findClusters(points, compressed);
  findAxes(points, compressed);
  return compressed;
}

}  // namespace haptex::appearance
