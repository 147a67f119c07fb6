#include "tensor/cluster_start.h"

#include <algorithm>
#include <limits>

#include "sphere/random.h"
#include "tensor/mode_product.h"

namespace velour {
namespace {

constexpr int kSteps = 20;

/// Samples each center in proportion to the squared distance to the nearest previous one.
RowMatrix seeds(const RowMatrix& points, Index count, uint64_t seed) {
  RowMatrix center(count, points.cols());
  std::vector<double> distance(static_cast<size_t>(points.rows()), std::numeric_limits<double>::infinity());
  RandomStream random(seed, 0, 0);
  Index next = std::min(points.rows() - 1, static_cast<Index>(random.next() * static_cast<float>(points.rows())));
  for (Index c = 0; c < count; ++c) {
    center.row(c) = points.row(next);
    double sum = 0;
    for (Index i = 0; i < points.rows(); ++i) {
      double& d = distance[static_cast<size_t>(i)];
      sum += d = std::min(d, static_cast<double>((points.row(i) - center.row(c)).squaredNorm()));
    }
    double rest = static_cast<double>(random.next()) * sum;
    for (next = 0; next + 1 < points.rows(); ++next) {
      rest -= distance[static_cast<size_t>(next)];
      if (rest < 0) break;
    }
  }
  return center;
}

uint32_t nearest(const RowMatrix& center, const Eigen::RowVectorXf& point) {
  Index best = 0;
  (center.rowwise() - point).rowwise().squaredNorm().minCoeff(&best);
  return static_cast<uint32_t>(best);
}

}  // namespace

RowMatrix slice_coordinates(const TensorView& slices, Index rank, const TensorOptions& options,
                            const Progress& progress) {
  const RowMatrix space = leading_vectors(slices, 1, rank, options, progress);
  const DenseTensor product = mode_product(slices, 1, space.transpose(), options.threads, progress);
  return Eigen::Map<const RowMatrix>(product.data.data(), product.extent[0], product.extent[1]);
}

std::vector<uint32_t> clusters_by_direction(RowMatrix points, Index clusters, uint64_t seed) {
  points.rowwise().normalize();  // zero stays zero
  RowMatrix center = seeds(points, clusters, seed);
  std::vector<uint32_t> member(static_cast<size_t>(points.rows()));
  for (int step = 0; step < kSteps; ++step) {
    RowMatrix sum = RowMatrix::Zero(center.rows(), center.cols());
    for (Index i = 0; i < points.rows(); ++i) {
      const uint32_t c = member[static_cast<size_t>(i)] = nearest(center, points.row(i));
      sum.row(c) += points.row(i);
    }
    for (Index c = 0; c < sum.rows(); ++c) sum.row(c).normalize();
    if (sum == center) break;
    center = sum;
  }
  return member;
}

std::vector<uint32_t> clusters_at_random(Index slices, Index clusters, uint64_t seed) {
  std::vector<uint32_t> member(static_cast<size_t>(slices));
  for (size_t i = 0; i < member.size(); ++i) {
    member[i] = static_cast<uint32_t>(RandomStream(seed, i, 1).next_bits() % static_cast<uint64_t>(clusters));
  }
  return member;
}

}  // namespace velour
