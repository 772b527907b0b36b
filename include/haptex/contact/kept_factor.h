// A sparse Cholesky factor that is kept over several steps and renewed piece by piece.
#pragma once

#include <vector>

#include "haptex/linear/block_matrix.h"
#include "haptex/linear/elimination.h"

namespace haptex::contact {

/// Left-looking supernodal factor L L^T of the leading part of a block matrix, in single precision:
/// the preconditioner of an iteration. Every panel can be renewed from the matrix of now and the
/// panels that it depends on as they are. So L may consist of pieces from different steps, and
/// L L^T is positive definite all the same.
///
/// Beside L each panel keeps [L11^-1; -L21 L11^-1], with which both substitutions are products with
/// dense panels: nothing waits for the number before.
///
/// The symbolic part and all memory belong to the constructor.
class KeptFactor {
 public:
  /// @param pattern of the leading part
  explicit KeptFactor(const linear::SymmetricBlockMatrix& pattern);

  /// Renews all panels.
  /// @param matrix has the constructor's pattern in its leading part
  /// @returns false if that is not positive definite to rounding in single precision, or has a
  ///   number that is not finite; the factor is then unusable
  bool factorise(const linear::SymmetricBlockMatrix& matrix);

  /// Renews the next panels: about `share` of the work, 0 to 1, after a factorise().
  /// @returns false if one was not positive definite: it stays as it was
  bool renew(const linear::SymmetricBlockMatrix& matrix, double share);

  /// z = (L L^T)^-1 r, of the leading columns.
  void solve(const linear::BlockVector& r, linear::BlockVector& z);

 private:
  struct Node {                // consecutive columns, in the order of elimination
    int first, width;          // block columns
    int first_row, row_count;  // block rows below, in rows_
    int height;                // numbers in a column of L
    int leading;               // from one column to the next, of both panels
    std::size_t offset;        // of both panels
    int first_entry, end_entry;
    int first_source, end_source;
    double cost;  // multiply-add operations
  };
  struct Entry {  // where a block of the matrix goes
    int slot;     // in lower(), or -1 - row in diagonal()
    int offset;   // in the panel
    bool transposed;
  };
  struct Source {  // an earlier node that updates this one
    int node;
    int begin, end;   // of its rows: those that are columns here
    int first_place;  // in places_: where its rows from `begin` on are here
  };
  void makeNodes(const linear::Elimination& elimination);
  void makeEntries(const linear::SymmetricBlockMatrix& pattern);
  void makeSources();
  int placeOf(const Node& node, int row) const;
  bool renewNode(int index, const linear::SymmetricBlockMatrix& matrix);
  void load(const Node& node, const linear::SymmetricBlockMatrix& matrix);
  void subtractSource(const Source& source, const Node& node);
  bool factorisePanel(const Node& node);
  void invertPanel(const Node& node);
  void forward(const Node& node);
  void backward(const Node& node);

  std::vector<int> order_, position_;  // as in Elimination
  std::vector<Node> nodes_;
  std::vector<int> node_of_;  // by column
  std::vector<int> rows_;
  std::vector<Entry> entries_;
  std::vector<Source> sources_;
  std::vector<int> places_;
  std::vector<float> lower_;     // panels of L, diagonals inverted
  std::vector<float> inverses_;  // [L11^-1; -L21 L11^-1]
  std::vector<float> panel_;     // that is being renewed
  std::vector<float> product_;
  std::vector<float> transposed_;
  std::vector<float> front_, values_;
  double scale_ = 1.0;  // by which the matrix is multiplied
  double cost_ = 0.0;
  int next_ = 0;  // to be renewed
};

}  // namespace haptex::contact
