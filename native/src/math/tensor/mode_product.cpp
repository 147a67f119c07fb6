#include "math/tensor/mode_product.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"

namespace velour {
namespace {

// Columns per piece of work. Fixed, so that sums do not depend on the number of threads. Pieces of summed products are
// longer because each adds a whole matrix to the sum.
constexpr Index kProductColumns = 256, kSummedColumns = 1024;
constexpr size_t kBlocks = 64;          // small blocks per piece
constexpr size_t kSums = 32;            // maximum number of partial sums; also fixed
constexpr size_t kSumBytes = 64 << 20;  // approximate size of all partial sums

/// Splits the columns of an unfolding into pieces of work.
class Pieces {
 public:
  Pieces(const Unfolding& u, Index together)
      : blocks_(u.blocks()),
        columns_(u.columns()),
        width_(together),
        parts_(static_cast<size_t>((u.columns() + together - 1) / together)),
        together_(parts_ == 1 ? kBlocks : 1) {}
  size_t count() const { return (blocks_ * parts_ + together_ - 1) / together_; }

  /// Calls use(block, first column, number of columns).
  template <class Use>
  void visit(size_t piece, const Use& use) const {
    const size_t end = std::min(blocks_ * parts_, (piece + 1) * together_);
    for (size_t i = piece * together_; i < end; ++i) {
      const Index begin = static_cast<Index>(i % parts_) * width_;
      use(i / parts_, begin, std::min(width_, columns_ - begin));
    }
  }

 private:
  size_t blocks_;
  Index columns_, width_;
  size_t parts_, together_;
};

/// Adds entries on and below the diagonal only.
void add_products(const StridedMatrix<const float>& columns, RowMatrix& product, Eigen::MatrixXd& sum) {
  multiply_by_itself(columns, {product.data(), product.rows(), product.cols(), product.cols(), 1});
  sum.triangularView<Eigen::Lower>() += product.cast<double>();
}

}  // namespace

DenseTensor mode_product(const TensorView& view, size_t mode, const RowMatrix& matrix, int threads,
                         const Progress& progress) {
  std::vector<Index> extents = view.extents();
  extents[mode] = matrix.rows();
  DenseTensor result(std::move(extents));
  const Unfolding from(view, mode), to(result.view(), mode, from);
  const Pieces pieces(from, kProductColumns);
  const StridedMatrix<const float> left{matrix.data(), matrix.rows(), matrix.cols(), matrix.cols(), 1};
  parallel_pieces(pieces.count(), threads, progress, [&](size_t piece) {
    pieces.visit(piece, [&](size_t block, Index begin, Index count) {
      multiply(left, from.part(view.data(), block, begin, count), to.part(result.data.data(), block, begin, count));
    });
  });
  return result;
}

Eigen::MatrixXd slice_products(const TensorView& view, size_t mode, int threads, const Progress& progress) {
  const Unfolding from(view, mode);
  const Pieces pieces(from, kSummedColumns);
  const auto bytes = static_cast<size_t>(from.rows() * from.rows()) * sizeof(double);
  const size_t sums = std::min({kSums, kSumBytes / bytes + 1, pieces.count()});
  std::vector<Eigen::MatrixXd> sum(sums, Eigen::MatrixXd::Zero(from.rows(), from.rows()));
  parallel_pieces(sums, threads, progress, [&](size_t s) {
    RowMatrix product(from.rows(), from.rows());
    for (size_t piece = s; piece < pieces.count(); piece += sums) {
      pieces.visit(piece, [&](size_t block, Index begin, Index count) {
        add_products(from.part(view.data(), block, begin, count), product, sum[s]);
      });
    }
  });
  for (size_t s = 1; s < sums; ++s) sum[0].triangularView<Eigen::Lower>() += sum[s];
  return sum[0].selfadjointView<Eigen::Lower>();
}

}  // namespace velour
