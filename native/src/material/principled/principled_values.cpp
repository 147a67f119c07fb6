// Highway compiles this file once for each instruction set.
#include "material/principled/principled_material.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/principled/principled_values.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "material/microfacet/ggx.h"
#include "math/sphere/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

#include "material/microfacet/ggx_formulas-inl.h"
#include "material/principled/principled_formulas-inl.h"

/// The density of PrincipledMaterial::sample, without that of glass. `wl` may lie below the horizon.
HWY_INLINE Lanes density(const PrincipledPoint& point, const Vec3& wv, const LanesVec3& wl, const LanesVec3& h) {
  const float coat = point.coat_end - point.specular_end, sheen = point.sheen_end - point.coat_end;
  Lanes sum = point.diffuse_end / kPi * larger(wl.z, 0.0f) +
              (point.specular_end - point.diffuse_end) * pdf_ggx_reflection(wv, h, point.alpha);
  if (coat > 0) sum = sum + coat * principled_coat_pdf(point, wv, h);
  if (sheen > 0) sum = sum + sheen * (sheen_value(point, wl) * larger(wl.z, 0.0f));
  return sum;
}

void eval_principled_simd(const PrincipledPoint& point, const Vec3& wv, const DirectionBatch& batch, RgbBatch& f,
                          ScalarBatch& pdf) {
  float* const channels[] = {f.r, f.g, f.b};
  for (int at = 0; at < batch.count; at += kLanes) {
    const LanesVec3 wl = load_directions(batch, at), h = half_vector(wv, wl);
    const auto parts = principled_parts(point, wv, wl, h);
    for (int c = 0; c < 3; ++c) {
      store_lanes(select(wl.z > 0.0f, principled_value(point, parts, c), 0.0f), channels[c] + at);
    }
    store_lanes(density(point, wv, wl, h), pdf.v + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(eval_principled_simd);

void eval_principled(const PrincipledPoint& point, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f,
                     ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(eval_principled_simd)(point, wv, wl, f, pdf);
}

}  // namespace velour
#endif
