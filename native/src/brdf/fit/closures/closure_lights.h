// Light directions of a fit of closures, and the BRDF there.
#pragma once

#include <functional>
#include <span>
#include <vector>
#include "base/memory.h"
#include "brdf/fit/direction_tree.h"
#include "math/sphere/vec.h"

namespace velour {

/// f in 1/sr without cosine for each of `wl`; wv.z > 0. Thread-safe.
using ClosureFunction = std::function<void(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f)>;

/// The BRDF that closures are fitted to.
struct ClosureSource {
  ClosureFunction f;
  bool isotropic = true;
};

/// The first `count` azimuths (radians) of views that stand for all, evenly spread; {0} if the source is isotropic.
std::vector<float> closure_azimuths(const ClosureSource& source, int count = 8);

/// f cos at a view, not negative.
std::vector<Rgb> source_values(const ClosureSource& source, const Vec3& wv, std::span<const Vec3> wl);

/// Widths of the sharpest highlights of a BRDF in planes of incidence, as alpha of a GGX lobe about the mirror
/// direction and about the viewer. At most 0.04 and 0.25.
struct HighlightWidths {
  float mirror, viewer;
};
HighlightWidths highlight_widths(const ClosureSource& source);

/// About `count` light directions above the horizon for the view at `theta_v` and `phi_v` (radians), and the solid
/// angles (sr) that they stand for: 30 % uniform over the hemisphere, 60 % about the mirror direction by GGX half
/// vectors of three widths, 10 % about the viewer, with the balance heuristic [VG95]. The same on every call.
WeightedLights closure_lights(const HighlightWidths& widths, float theta_v, int count, float phi_v = 0);

/// Lights of one view, structure of arrays, padded with lights of no weight, so that loops have no tails. Unit
/// directions in the frame of the lobes (ClosureFrame): phi_v is 0 where x lies in the plane of incidence.
class ClosureLights {
 public:
  static constexpr size_t kPadding = 16;

  ClosureLights(float theta_v, const WeightedLights& lights, float phi_v = 0);

  float theta_v() const { return theta_v_; }  // radians
  float phi_v() const { return phi_v_; }
  size_t padded() const { return padded_; }
  const float* wl_x() const { return row(0); }
  const float* wl_y() const { return row(1); }
  const float* wl_z() const { return row(2); }
  const float* h_x() const { return row(3); }
  const float* h_y() const { return row(4); }
  const float* h_z() const { return row(5); }
  const float* root_weight() const { return row(6); }  // square root of the solid angle, times that of emphasize_dim()
  float* root_weight() { return data_.data() + 6 * padded_; }

 private:
  const float* row(size_t i) const { return data_.data() + i * padded_; }

  float theta_v_, phi_v_;
  size_t padded_;
  AlignedArray<float> data_;
};

/// Values of the source at the lights of a view.
struct ClosureTarget {
  ClosureLights lights;
  AlignedArray<float> values;    // f cos times root_weight, a row per channel
  AlignedArray<float> integral;  // a row times root_weight, times this, sums to its integral
  Vec3d norm_sq{0}, albedo{0};
  double norm_sq_luminance = 0;

  const float* channel(int c) const { return values.data() + static_cast<size_t>(c) * lights.padded(); }
};
ClosureTarget closure_target(const ClosureSource& source, const HighlightWidths& widths, float theta_v, int count,
                             float phi_v = 0);

/// Raises the weights of lights where the target is dim, so that squared errors, relative to norm_sq, become the sum of
/// those of f cos and of `share` times those of its root. Peaks of highlights alone count in the former, but what
/// surrounds them is visible, too.
void emphasize_dim(ClosureTarget& target, double share);

}  // namespace velour
