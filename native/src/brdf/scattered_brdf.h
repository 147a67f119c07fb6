// The scattered univariate SRBF model of a BRDF: one mixture a sampled view direction [T09 7.2], and a cosine term for
// what is diffuse: positive lobes are poor at the clipped cosine (16 of them leave 2.4 % of a Lambertian slice).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sphere/vec.h"
#include "srbf/kernel.h"

namespace velour {

/// Slices of f cos(theta_l) over wl, one a view. Plain data; immutable once inside a Model.
struct ScatteredBrdf {
  Kernel kernel = Kernel::gaussian;
  /// Isotropic: views lie on the meridian phi_v = 0 and slices turn with the view. Otherwise over the hemisphere.
  bool isotropic = true;
  /// Slices of neighbouring views are turned so that their mirror directions coincide with the query's before they are
  /// mixed; false mixes them as they are (a sharp highlight then doubles between views).
  bool align_views = true;
  int default_neighbors = usual_neighbors(true);  // K of the interpolation

  std::vector<Vec3> views;   // unit, sorted by theta_v when isotropic
  std::vector<Rgb> diffuse;  // one a view: coefficient of max(wl.z, 0) in f cos; non-negative, 1/sr. Empty: none
  std::vector<uint32_t> first_lobe;  // views.size() + 1 offsets into the arrays below
  std::vector<Vec3> center;          // unit
  std::vector<float> bandwidth;
  std::vector<Rgb> coefficient;  // of f cos, non-negative, 1/sr

  /// K of the interpolation unless asked otherwise: 2 on the meridian, 4 on the hemisphere as in [T09].
  static constexpr int usual_neighbors(bool on_meridian) { return on_meridian ? 2 : 4; }

  int lobe_count() const { return static_cast<int>(center.size()); }
  int max_lobes_per_view() const {
    uint32_t most = 0;
    for (size_t i = 0; i + 1 < first_lobe.size(); ++i) most = std::max(most, first_lobe[i + 1] - first_lobe[i]);
    return static_cast<int>(most);
  }
  /// Bytes of the coefficients alone: 7 floats a lobe and 6 a view.
  static constexpr uint64_t kLobeBytes = 28, kViewBytes = 24;
  uint64_t parameter_bytes() const { return kLobeBytes * center.size() + kViewBytes * views.size(); }
};

}  // namespace velour
