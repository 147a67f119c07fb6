// Importance sampling from tables of f cos over the view: one smooth map of the unit square to the sphere.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "material/table_point.h"
#include "material/view_nodes.h"
#include "sphere/direction_batch.h"

namespace velour {

class Material;

/// The density is bilinear in solid angle and azimuth about the mirror direction of the view (TableGrid), and between
/// views the mixture of the nodes' densities, each turned with the mirror direction. Random numbers go through the
/// inverse of the *mixed* distribution [RGL], so neither nodes nor lobes cut the square in pieces and points that are
/// even there are even on the sphere. Immutable; thread-safe; no allocation after construction.
class TableSampler {
 public:
  /// Sets `f_cos` to the luminance of f times the cosine at `wv` (wv.z > 0) of the padded batches `wl`; below the
  /// horizon it is 0. Called from several threads at once.
  using Luminance =
      std::function<void(const Vec3& wv, std::span<const DirectionBatch> wl, std::span<ScalarBatch> f_cos)>;
  /// Isotropic: nodes on one meridian.
  TableSampler(bool isotropic, const Luminance& luminance);
  explicit TableSampler(const Material& material);

  /// Needs wv.z > 0.
  void prepare(const Vec3& wv, TablePoint& point) const;
  /// A direction for each of up to 64 `u`; it may lie below the horizon. The batch is not padded.
  static void sample(const TablePoint& point, std::span<const Vec2> u, DirectionBatch& wl);
  /// Density per solid angle of each direction of a padded batch, above 0 on and above the horizon.
  static void pdf(const TablePoint& point, const DirectionBatch& wl, ScalarBatch& pdf);
  static float pdf(const TablePoint& point, const Vec3& wl);
  uint64_t bytes() const { return sizeof(float) * tables_.size(); }

  /// A lobe of f cos: its integral, centre above the horizon, and all f cos there, luminances.
  struct Peak {
    double mass;
    Vec3 wl;
    double f_cos;
  };
  /// Whether draws at `wv` serve f cos of these lobes. Not where lobes are so much narrower than the cells that they
  /// lie in that f cos / density at their centres is more than kResolved times its mean, and their part of the relative
  /// variance may be above kMostVariance.
  bool resolve(const Vec3& wv, std::span<const Peak> peaks) const;
  static constexpr double kResolved = 2, kMostVariance = 30;

 private:
  void fill_node(const Luminance& luminance, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<float> tables_;  // [node][TableLayout]
};

}  // namespace velour
