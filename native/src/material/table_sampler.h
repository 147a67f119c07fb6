// Importance sampling from a tabulated cumulative distribution of f cos: the peer of the SRBF sampler.
#pragma once

#include <memory>

#include "material/material.h"

namespace velour {

/// Piecewise constant density over cells of the hemisphere, one table a view. Immutable, thread-safe.
class TableSampler {
 public:
  /// Tabulates luminance(f) cos of `material` (one meridian of views when isotropic).
  explicit TableSampler(const Material& material);
  ~TableSampler();

  Vec3 sample(const Vec3& wv, const Vec2& u) const;
  /// Density per solid angle of each direction.
  void pdf(const Vec3& wv, const DirectionBatch& wl, ScalarBatch& pdf) const;
  uint64_t bytes() const;

 private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace velour
