// A dense table over half and difference angles: MERL's, Velour's own, and resampled irregular samples.
#pragma once

#include <vector>

#include "brdf/brdf_table.h"
#include "brdf/half_diff.h"
#include "brdf/measurement.h"

namespace velour {

/// r, g, b and 1 for a valid node; four zeros for an invalid one, so that one weighted sum gives both the value and the
/// weight of the valid nodes.
struct alignas(16) TableNode {
  float value[4] = {0, 0, 0, 0};
};

class HalfDiffTable {
 public:
  /// `nodes` are indexed by layout.index(). A MERL table is the layout {90, 1, 90, 180}.
  HalfDiffTable(const BrdfTableLayout& layout, std::vector<TableNode> nodes);

  /// Multilinear in the table's own coordinates over the valid corners, whose weights are scaled to sum to one;
  /// periodic in the azimuths, clamped past the last node. False, and f = 0, if no corner is valid. Both directions
  /// must be above the horizon.
  bool lookup(const Vec3& wl, const Vec3& wv, Rgb& f) const;

  const BrdfTableLayout& layout() const { return layout_; }

 private:
  /// Two neighboring nodes on an axis and the weight of the second.
  struct Step {
    size_t low, high;
    float weight;
  };
  static Step clamped(float position, int count);
  static Step periodic(float position, int count);
  Step theta_h_step(float theta_h) const;
  void add_plane(size_t base, const Step& theta_d, const Step& phi_d, float weight, float sum[4]) const;

  BrdfTableLayout layout_;
  std::vector<TableNode> nodes_;
};

/// Which nodes of a layout have both directions above the horizon.
class HorizonTest {
 public:
  explicit HorizonTest(const BrdfTableLayout& layout);
  bool above(int i, int k, int l) const {
    const double upright = cos_h_[size(i)] * cos_d_[size(k)];
    return upright > std::abs(sin_h_[size(i)] * sin_d_[size(k)] * cos_phi_[size(l)]);
  }

 private:
  static size_t size(int a) { return static_cast<size_t>(a); }
  std::vector<double> sin_h_, cos_h_, sin_d_, cos_d_, cos_phi_;
};

}  // namespace velour
