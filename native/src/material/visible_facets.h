// Integrals over the microfacets visible from a view.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Quadrature of the mean over visible GGX normals [H18], for integrands symmetric about the xz plane, in which the
/// view lies. The integrand is smooth at any roughness. Arrays let compilers vectorize.
struct VisibleFacets {
  static constexpr int kCount = 24 * 24;
  float cosine[kCount];   // between view and facet
  float masking[kCount];  // G2 / G1 of the mirrored direction; 0: it is below the horizon

  /// Requires wv.y = 0.
  VisibleFacets(const Vec3& wv, const Vec2& alpha);
  /// Weights of the facets; they sum to 1.
  static const double* weights();
};

/// Calls `add(weight, cosine, masking)` for each facet.
template <class Add>
void for_visible_facets(const Vec3& wv, const Vec2& alpha, const Add& add) {
  const VisibleFacets facets(wv, alpha);
  const double* const weight = VisibleFacets::weights();
  for (int i = 0; i < VisibleFacets::kCount; ++i) add(weight[i], facets.cosine[i], facets.masking[i]);
}

}  // namespace velour
