// The per-view univariate SRBF model of a BRDF: one mixture per sampled view direction [T09 7.2], and a cosine term for
// the diffuse part, since positive lobes fit the clipped cosine poorly (16 of them leave 2.4 % of a Lambertian slice).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/sphere/vec.h"
#include "math/srbf/kernel.h"

namespace velour {

/// Slices of f cos(theta_l) over wl, one per view. Plain data; immutable once inside a Model.
struct PerViewBrdf {
  Kernel kernel = Kernel::gaussian;
  /// If true, views lie on the meridian phi_v = 0 and slices rotate with the view; otherwise they cover the hemisphere.
  bool isotropic = true;
  /// Slices of neighboring views are rotated so that their mirror directions coincide with the query's before they are
  /// mixed; false mixes them unrotated (a sharp highlight is then doubled between views).
  bool align_views = true;
  int default_neighbors = usual_neighbors(true);  // K of the interpolation

  std::vector<Vec3> views;   // unit, sorted by theta_v when isotropic
  std::vector<Rgb> diffuse;  // one per view: coefficient of max(wl.z, 0) in f cos; non-negative, 1/sr. Empty: none
  std::vector<uint32_t> first_lobe;  // views.size() + 1 offsets into the arrays below
  std::vector<Vec3> center;          // unit
  std::vector<float> bandwidth;
  std::vector<Rgb> coefficient;  // of f cos, non-negative, 1/sr

  /// Default K of the interpolation: 2 on the meridian, 4 on the hemisphere as in [T09].
  static constexpr int usual_neighbors(bool on_meridian) { return on_meridian ? 2 : 4; }

  int lobe_count() const { return static_cast<int>(center.size()); }
  int max_lobes_per_view() const {
    uint32_t most = 0;
    for (size_t i = 0; i + 1 < first_lobe.size(); ++i) most = std::max(most, first_lobe[i + 1] - first_lobe[i]);
    return static_cast<int>(most);
  }
  /// Bytes of the coefficients alone: 7 floats per lobe and 6 per view.
  static constexpr uint64_t kLobeBytes = 28, kViewBytes = 24;
  uint64_t parameter_bytes() const { return kLobeBytes * center.size() + kViewBytes * views.size(); }
};

}  // namespace velour
