// In which order lobes are worth their bytes.
#pragma once

#include <array>

#include "compress/lobe_pursuit.h"
#include "compress/surface_points.h"

namespace velour {

/// Lobes to choose from: random ones of light, view, half vector and their products, those of the tile's frame first.
/// The first is the constant.
struct LobeCandidates {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
};
inline constexpr uint32_t kLobeCandidates = 2048;
inline constexpr uint64_t kOrderPairs = 400;  // of a point that an order is chosen by
LobeCandidates random_candidates(uint64_t seed);

/// Values of all candidates at the first points, pair x candidate each, and of the points along an axis.
std::vector<RowMatrix> candidate_columns(const std::vector<SurfacePoint>& points, const LobeCandidates& candidates,
                                         size_t most_points, size_t most_pairs, int threads, const Progress& progress);
std::vector<Eigen::VectorXf> point_values(const std::vector<SurfacePoint>& points,
                                          const std::vector<RowMatrix>& columns, size_t axis);

/// Coefficients of a texel, one by one: each goes to the colour axis whose next candidate explains the most.
struct LobeOrder {
  std::array<std::vector<size_t>, 3> candidate;  // of each axis, the most useful first; of axis 0 at least one
  std::vector<uint8_t> axis;                     // of each coefficient
  std::vector<double> left;                      // share of all squares that is left after each

  /// How many of the first `count` coefficients go to each axis.
  std::array<size_t, 3> share(size_t count) const;
};

struct LobeOrderOptions {
  size_t most = 0;       // coefficients
  double least = 0;      // share of squares: it ends where no more are left
  uint32_t points = 64;  // that they are chosen by
  uint64_t seed = 0;
  int threads = 0;
};

/// By greedy choice among random candidates. Nothing to explain, as in what is black, takes the constant.
LobeOrder order_lobes(const std::vector<SurfacePoint>& points, const LobeOrderOptions& options, Progress& progress);

}  // namespace velour
