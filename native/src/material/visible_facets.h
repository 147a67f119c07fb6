// Integrals over the microfacets that a view sees.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// A rule for the mean over GGX's visible normals [H18] of what is the same on both sides of the plane of x and z, in
/// which the view lies: the integrand is smooth whatever the roughness. As arrays: compilers compute several at once.
struct VisibleFacets {
  static constexpr int kCount = 24 * 24;
  float cosine[kCount];   // between view and facet
  float masking[kCount];  // G2 / G1 of the mirrored direction; 0: it is below the horizon

  /// `wv.y` is 0.
  VisibleFacets(const Vec3& wv, const Vec2& alpha);
  /// They add up to 1.
  static const double* weights();
};

/// Calls `add(weight, cosine, masking)` for each.
template <class Add>
void for_visible_facets(const Vec3& wv, const Vec2& alpha, const Add& add) {
  const VisibleFacets facets(wv, alpha);
  const double* const weight = VisibleFacets::weights();
  for (int i = 0; i < VisibleFacets::kCount; ++i) add(weight[i], facets.cosine[i], facets.masking[i]);
}

}  // namespace velour
