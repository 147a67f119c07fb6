// The highlight of a Principled material as lobes of half vectors.
#pragma once

#include <vector>

#include "material/principled_material.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// GGX's distribution of normals is proportional to 1 / (1 + t^2)^2, t = tan(theta) / alpha: here a sum of Gaussians
/// exp(-s t^2), 1.5 % off in L2 over t^2 and 0.3 % in what all of it reflects.
class GgxLobes {
 public:
  static constexpr int kLobes = 4;
  explicit GgxLobes(const PrincipledParameters& parameters);

  /// At a view: of f cos, with masking and Fresnel's term as they are at the mirror direction.
  std::vector<WarpedLobe> lobes(const Vec3d& wv) const;
  /// Masking and Fresnel's term at a pair over those at the mirror direction of its view.
  Vec3d growth(const Vec3d& wl, const Vec3d& wv) const;
  /// f of what is no highlight, and of the whole material.
  Vec3d base(const Vec3d& wl, const Vec3d& wv) const;
  Vec3d f(const Vec3d& wl, const Vec3d& wv) const;

 private:
  double masking(double first, double second) const;  // by cosines to the normal [H14]

  PrincipledParameters parameters_;
  double alpha_;
  PrincipledMaterial whole_, base_;
};

}  // namespace velour
