// The highlight of a Principled material as lobes over half vectors.
#pragma once

#include <vector>

#include "material/principled_material.h"
#include "srbf/warped_lobe.h"

namespace velour {

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
