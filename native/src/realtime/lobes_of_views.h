// The lobes of a material at a view, before their conversion to Gaussians over light directions.
#pragma once

#include <memory>
#include <vector>
#include "brdf/model/parametric_brdf.h"
#include "material/principled/principled_material.h"
#include "material/principled/principled_point.h"
#include "math/srbf/warped_lobe.h"
#include "realtime/light_gaussians.h"

namespace velour {

class LobesOfViews {
 public:
  virtual ~LobesOfViews() = default;
  virtual LobeOf of() const = 0;
  /// The lobes at a view; their number is the same at every view.
  virtual std::vector<ReachedLobe> lobes(const Vec3d& wv) const = 0;
  /// Ratio of lobe `j` of `lobes(wv)` at `wl` to the Gaussian of its argument there.
  virtual Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const = 0;
  /// f of the lobes marked in `soft`, plus everything that no lobe reflects.
  virtual Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const = 0;
};

/// A symmetric model has twice its lobes here: those of the view, then those of the light. `brdf` must outlive the
/// result.
std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf);
std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters);

// The highlight of a Principled material as lobes over half vectors.

/// GGX's distribution of normals is proportional to 1 / (1 + t^2)^2, t = tan(theta) / alpha: here a sum of Gaussians
/// exp(-s t^2), with an error of 1.5 % in L2 over t^2 and of 0.3 % in the total reflection.
class GgxLobes {
 public:
  static constexpr int kLobes = 4;
  explicit GgxLobes(const PrincipledParameters& parameters);

  /// Lobes of f cos at a view, with masking and Fresnel term evaluated at the mirror direction.
  std::vector<WarpedLobe> lobes(const Vec3d& wv) const;
  /// Masking and Fresnel term at a pair, relative to those at the mirror direction of its view.
  Vec3d growth(const Vec3d& wl, const Vec3d& wv) const;
  /// f without the highlight, and f of the whole material.
  Vec3d base(const Vec3d& wl, const Vec3d& wv) const;
  Vec3d f(const Vec3d& wl, const Vec3d& wv) const;

 private:
  double masking(double first, double second) const;  // of cosines to the normal [H14]

  PrincipledParameters parameters_;
  double alpha_;
  PrincipledMaterial whole_, base_;
};

}  // namespace velour
