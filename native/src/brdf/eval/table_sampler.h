// Importance sampling from per-view tables of f cos: one smooth map of the unit square to the sphere.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "brdf/eval/view_nodes.h"
#include "math/sphere/directions.h"

namespace velour {

class Material;

/// Partition of the sphere about an axis: rows of d = 1 - cos of the angle to it, with edges at 2 (k / kRows)^4, and
/// columns of equal length along the square |x| + |y| = 1 in azimuth.
struct TableGrid {
  static constexpr int kColumnBits = 5;
  static constexpr int kRows = 64, kColumns = 1 << kColumnBits;  // multiples of 16
  static constexpr int kRowsPadded = kRows + 16;

  static constexpr float row_edge(int row) {
    const float s = static_cast<float>(row) / kRows;
    return 2 * (s * s) * (s * s);
  }
};

/// State at a view: the tables of two or four nodes, their weights in the mixture, and their frame.
struct TablePoint {
  const float* table[4];
  float weight[4];
  int count = 0;
  float mass;  // integral of the tables: luminance of f cos and the defensive share
  Vec3 tangent, bitangent, axis;
};

/// The density is bilinear in d and azimuth about the view's mirror direction (TableGrid). Between views it is the
/// mixture of the nodes' densities, each rotated with the mirror direction. Random numbers go through the inverse of
/// the *mixed* distribution [RGL], so neither nodes nor lobes split the square, and well-distributed points there stay
/// well-distributed on the sphere. Immutable; thread-safe; no allocation after construction.
class TableSampler {
 public:
  /// Sets `f_cos` to the luminance of f times the cosine for view `wv` (wv.z > 0) and the padded batches `wl`; 0 below
  /// the horizon. Called from several threads concurrently.
  using Luminance =
      std::function<void(const Vec3& wv, std::span<const DirectionBatch> wl, std::span<ScalarBatch> f_cos)>;
  /// Isotropic: nodes on one meridian.
  TableSampler(bool isotropic, const Luminance& luminance);
  explicit TableSampler(const Material& material);

  /// Requires wv.z > 0.
  void prepare(const Vec3& wv, TablePoint& point) const;
  /// Samples a direction for each of up to 64 `u`; it may lie below the horizon. The batch is not padded.
  static void sample(const TablePoint& point, std::span<const Vec2> u, DirectionBatch& wl);
  /// Density per solid angle of each direction of a padded batch; positive on and above the horizon.
  static void pdf(const TablePoint& point, const DirectionBatch& wl, ScalarBatch& pdf);
  static float pdf(const TablePoint& point, const Vec3& wl);
  uint64_t bytes() const { return sizeof(float) * tables_.size(); }

  /// A lobe of f cos: its integral, its center (above the horizon), and the total f cos there, as luminances.
  struct Peak {
    double mass;
    Vec3 wl;
    double f_cos;
  };
  /// Whether the tables sample these lobes of f cos well at `wv`. False if some lobes are so much narrower than their
  /// cells that f cos / density at their centers exceeds kResolved times its mean, and they may contribute a relative
  /// variance above kMaxVariance.
  bool resolve(const Vec3& wv, std::span<const Peak> peaks) const;
  static constexpr double kResolved = 2, kMaxVariance = 30;

 private:
  void fill_node(const Luminance& luminance, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<float> tables_;  // [node][TableLayout]
};

}  // namespace velour
