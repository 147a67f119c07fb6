#include "math/tensor/tensor_view.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/parallel.h"

namespace velour {

namespace {

Index product(const std::vector<Index>& extents) {
  return std::accumulate(extents.begin(), extents.end(), Index{1}, std::multiplies<>());
}

std::vector<Index> row_major(const std::vector<Index>& extents) {
  std::vector<Index> strides(extents.size(), 1);
  for (size_t mode = extents.size(); mode-- > 1;) strides[mode - 1] = strides[mode] * extents[mode];
  return strides;
}

void copy_mode(const TensorView& view, size_t mode, const float* from, float*& to) {
  if (mode == view.order()) {
    *to++ = *from;
    return;
  }
  for (Index i = 0; i < view.extent(mode); ++i) copy_mode(view, mode + 1, from + i * view.stride(mode), to);
}

}  // namespace

TensorView::TensorView(const float* data, std::vector<Index> extents)
    : data_(data), extent_(std::move(extents)), stride_(row_major(extent_)) {}

TensorView::TensorView(const float* data, std::vector<Index> extents, std::vector<Index> strides)
    : data_(data), extent_(std::move(extents)), stride_(std::move(strides)) {}

Index TensorView::size() const { return product(extent_); }

TensorView TensorView::range(size_t mode, Index first, Index count) const {
  TensorView part = *this;
  part.data_ += first * stride_[mode];
  part.extent_[mode] = count;
  return part;
}

TensorView TensorView::permuted(const std::vector<size_t>& order) const {
  TensorView other = *this;
  for (size_t i = 0; i < order.size(); ++i) {
    other.extent_[i] = extent_[order[i]];
    other.stride_[i] = stride_[order[i]];
  }
  return other;
}

DenseTensor::DenseTensor(std::vector<Index> extents)
    : extent(std::move(extents)), data(static_cast<size_t>(product(extent))) {}

double DenseTensor::squared_norm() const {
  double sum = 0;
  for (const float x : data) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

DenseTensor copied(const TensorView& view) {
  DenseTensor tensor(view.extents());
  float* to = tensor.data.data();
  copy_mode(view, 0, view.data(), to);
  return tensor;
}

namespace {

constexpr Index kEnoughColumns = 16;  // enough to fill the registers

}  // namespace

Unfolding::Unfolding(const TensorView& view, size_t mode) {
  for (size_t k = 0; k < view.order(); ++k) {
    if (k == mode) continue;
    const bool evenly = k > 0 && k - 1 != mode && view.stride(k - 1) == view.stride(k) * view.extent(k);
    if (evenly) {
      group_.back().second = k;
    } else {
      group_.emplace_back(k, k);
    }
  }
  // Too few columns would leave registers empty; a large stride would waste cache lines.
  const auto rank = [&](const Group& group) {
    Index extent = 1;
    for (size_t k = group.first; k <= group.second; ++k) extent *= view.extent(k);
    return std::pair(std::min(extent, kEnoughColumns), -view.stride(group.second));
  };
  for (size_t g = 1; g < group_.size(); ++g) {
    if (rank(group_[g]) > rank(group_[column_group_])) column_group_ = g;
  }
  lay_out(view, mode);
}

Unfolding::Unfolding(const TensorView& view, size_t mode, const Unfolding& like)
    : group_(like.group_), column_group_(like.column_group_) {
  lay_out(view, mode);
}

void Unfolding::lay_out(const TensorView& view, size_t mode) {
  rows_ = view.extent(mode);
  row_stride_ = view.stride(mode);
  first_ = {0};
  for (size_t g = 0; g < group_.size(); ++g) {
    Index extent = 1;
    for (size_t k = group_[g].first; k <= group_[g].second; ++k) extent *= view.extent(k);
    const Index stride = view.stride(group_[g].second);
    if (g == column_group_) {
      columns_ = extent;
      column_stride_ = stride;
      continue;
    }
    std::vector<Index> next;
    for (const Index from : first_) {
      for (Index i = 0; i < extent; ++i) next.push_back(from + i * stride);
    }
    first_ = std::move(next);
  }
}

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
