// Tensors of random numbers, and what definitions say of them.
#pragma once

#include "math/sphere/random.h"
#include "math/tensor/decompositions.h"

namespace velour::test {

inline DenseTensor random_tensor(std::vector<Index> extents, uint64_t seed) {
  DenseTensor tensor(std::move(extents));
  uint64_t entry = 0;
  for (float& x : tensor.data) x = RandomStream(seed, entry++, 0).next() - 0.5f;
  return tensor;
}

inline RowMatrix random_matrix(Index rows, Index columns, uint64_t seed) {
  const DenseTensor tensor = random_tensor({rows, columns}, seed);
  return Eigen::Map<const RowMatrix>(tensor.data.data(), rows, columns);
}

/// A random tensor of exactly the given Tucker ranks.
inline DenseTensor random_tucker(const std::vector<Index>& extents, const std::vector<Index>& ranks, uint64_t seed) {
  Tucker tucker{{}, random_tensor(ranks, seed)};
  for (size_t mode = 0; mode < extents.size(); ++mode) {
    tucker.factor.push_back(random_matrix(extents[mode], ranks[mode], seed + 1 + mode));
  }
  return expanded(tucker, {}, Progress());
}

/// truncated_hosvd, then so many sweeps.
inline Tucker swept_tucker(const TensorView& view, const std::vector<Index>& ranks, int sweeps,
                           const TensorOptions& options = {}) {
  Tucker tucker = truncated_hosvd(view, ranks, options, Progress());
  for (int sweep = 0; sweep < sweeps; ++sweep) hooi_sweep(view, tucker, options, Progress());
  return tucker;
}

inline double squared_distance(const DenseTensor& a, const DenseTensor& b) {
  double sum = 0;
  for (size_t i = 0; i < a.data.size(); ++i) {
    const double d = static_cast<double>(a.data[i]) - static_cast<double>(b.data[i]);
    sum += d * d;
  }
  return sum;
}

/// Largest difference between the dot products of the columns and those of orthonormal columns.
inline float orthonormality_error(const RowMatrix& m) {
  return (m.transpose() * m - RowMatrix::Identity(m.cols(), m.cols())).cwiseAbs().maxCoeff();
}

}  // namespace velour::test
