#include "tensor/leading_eigenvectors.h"

#include <algorithm>
#include <optional>

#include "job/parallel.h"
#include "sphere/random.h"
#include "tensor/decompositions.h"

namespace velour {
namespace {

constexpr Index kBlockOversampling = 8;
constexpr Index kLeastSide = 160;   // smallest matrix for which a Krylov space pays off
constexpr Index kLeastBlocks = 6;   // that must fit in the space; with fewer a decomposition is cheaper
constexpr double kResidual = 1e-7;  // relative to the largest eigenvalue
constexpr Index kRows = 128;        // per piece of work

Eigen::MatrixXd decomposed(const Eigen::MatrixXd& products, Index rank) {
  return eigenpairs(products).vector.leftCols(rank);
}

Eigen::MatrixXd random_block(Index rows, Index columns, uint64_t seed) {
  Eigen::MatrixXd block(rows, columns);
  for (Index c = 0; c < columns; ++c) {
    RandomStream random(seed, static_cast<uint64_t>(c), 0);
    for (Index r = 0; r < rows; ++r) block(r, c) = static_cast<double>(random.next()) - 0.5;
  }
  return block;
}

/// Krylov space of a random block and its repeated products with the matrix; grows block by block.
class KrylovSpace {
 public:
  KrylovSpace(const Eigen::MatrixXd& products, Index block, Index most, const TensorOptions& options,
              const Progress& progress)
      : products_(products), options_(options), progress_(progress), basis_(products.rows(), most), image_(basis_) {
    next_ = orthonormal_doubles(random_block(products.rows(), block, options.seed));
  }

  bool has_room() const { return size_ + next_.cols() <= basis_.cols(); }

  void grow() {
    const Index block = next_.cols();
    basis_.middleCols(size_, block) = next_;
    parallel_pieces(
        static_cast<size_t>((products_.rows() + kRows - 1) / kRows), options_.threads, progress_, [&](size_t piece) {
          const Index begin = static_cast<Index>(piece) * kRows, count = std::min(kRows, products_.rows() - begin);
          image_.block(begin, size_, count, block).noalias() = products_.middleRows(begin, count) * next_;
        });
    next_ = image_.middleCols(size_, block);
    size_ += block;
    // Orthogonalizing once is not enough where little of the image lies outside the space.
    for (int twice = 0; twice < 2; ++twice) {
      const auto before = basis_.leftCols(size_);
      next_ = orthonormal_doubles(next_ - before * (before.transpose() * next_).eval());
    }
  }

  /// Ritz vectors, the best approximations of the leading eigenvectors in the space; none if residuals are too large.
  std::optional<Eigen::MatrixXd> leading(Index rank) const {
    const auto basis = basis_.leftCols(size_), image = image_.leftCols(size_);
    const Eigenpairs pairs = eigenpairs(basis.transpose() * image);
    const Eigen::MatrixXd weight = pairs.vector.leftCols(rank);
    const Eigen::VectorXd value = pairs.value.head(rank);
    Eigen::MatrixXd vectors = basis * weight;
    const Eigen::MatrixXd residual = image * weight - vectors * value.asDiagonal();
    if (!(residual.colwise().norm().maxCoeff() <= kResidual * value[0])) return std::nullopt;
    return vectors;
  }

 private:
  const Eigen::MatrixXd& products_;
  TensorOptions options_;
  const Progress& progress_;
  Eigen::MatrixXd basis_, image_, next_;
  Index size_ = 0;
};

}  // namespace

Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& products, Index rank, const TensorOptions& options,
                                     const Progress& progress) {
  const Index side = products.rows(), block = rank + kBlockOversampling, most = side / 2;
  if (side < kLeastSide || kLeastBlocks * block > most) return decomposed(products, rank);
  KrylovSpace space(products, block, most, options, progress);
  while (space.has_room()) {
    space.grow();
    if (const auto found = space.leading(rank)) return *found;
  }
  return decomposed(products, rank);
}

}  // namespace velour
