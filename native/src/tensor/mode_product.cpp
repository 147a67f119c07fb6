#include "tensor/mode_product.h"

#include <algorithm>
#include <array>

#include "job/parallel.h"

namespace velour {
namespace {

constexpr Index kColumns = 1024;  // of a piece of work: fixed, so that sums do not depend on threads
constexpr size_t kBlocks = 64;    // small blocks of a piece
constexpr size_t kSums = 32;      // partial sums, at most: fixed as well

/// The columns of an unfolding in pieces.
class Pieces {
 public:
  explicit Pieces(const Unfolding& u)
      : blocks_(u.blocks()),
        columns_(u.columns()),
        parts_(static_cast<size_t>((u.columns() + kColumns - 1) / kColumns)),
        together_(parts_ == 1 ? kBlocks : 1) {}
  size_t count() const { return (blocks_ * parts_ + together_ - 1) / together_; }

  /// use(block, first column, columns).
  template <class Use>
  void visit(size_t piece, const Use& use) const {
    const size_t end = std::min(blocks_ * parts_, (piece + 1) * together_);
    for (size_t i = piece * together_; i < end; ++i) {
      const Index begin = static_cast<Index>(i % parts_) * kColumns;
      use(i / parts_, begin, std::min(kColumns, columns_ - begin));
    }
  }

 private:
  size_t blocks_;
  Index columns_;
  size_t parts_, together_;
};

template <class M>
void add_products(const M& columns, Eigen::MatrixXd& sum) {
  const Eigen::MatrixXf product = columns * columns.transpose();
  sum += product.template cast<double>();
}

}  // namespace

DenseTensor mode_product(const TensorView& view, size_t mode, const RowMatrix& matrix, int threads,
                         const Progress& progress) {
  std::vector<Index> extents = view.extents();
  extents[mode] = matrix.rows();
  DenseTensor result(std::move(extents));
  const Unfolding from(view, mode), to(result.view(), mode, from);
  const Pieces pieces(from);
  parallel_pieces(pieces.count(), threads, progress, [&](size_t piece) {
    pieces.visit(piece, [&](size_t block, Index begin, Index count) {
      with_columns(view.data(), from, block, begin, count, [&](const auto& columns) {
        using Both = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
        float* const target = result.data.data() + to.first(block) + begin * to.column_stride();
        Eigen::Map<RowMatrix, 0, Both>(target, to.rows(), count, Both(to.row_stride(), to.column_stride())) =
            matrix * columns;
      });
    });
  });
  return result;
}

Eigen::MatrixXd slice_products(const TensorView& view, size_t mode, int threads, const Progress& progress) {
  const Unfolding from(view, mode);
  const Pieces pieces(from);
  const size_t sums = std::min(kSums, pieces.count());
  std::vector<Eigen::MatrixXd> sum(sums, Eigen::MatrixXd::Zero(from.rows(), from.rows()));
  parallel_pieces(sums, threads, progress, [&](size_t s) {
    for (size_t piece = s; piece < pieces.count(); piece += sums) {
      pieces.visit(piece, [&](size_t block, Index begin, Index count) {
        with_columns(view.data(), from, block, begin, count,
                     [&](const auto& columns) { add_products(columns, sum[s]); });
      });
    }
  });
  for (size_t s = 1; s < sums; ++s) sum[0] += sum[s];
  return sum[0];
}

}  // namespace velour
