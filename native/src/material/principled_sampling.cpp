// Highway compiles this file once for each instruction set.
#include "material/principled_sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/principled_sampling.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "material/ggx.h"
#include "srbf/lanes-inl.h"
#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

#include "material/ggx_formulas-inl.h"
#include "material/principled_formulas-inl.h"

/// Density of PrincipledSampling::sample. `wl` may lie below the horizon.
HWY_INLINE Lanes density(const PrincipledLobes::Layers& layers, const PrincipledShares& shares, const Vec3& wv,
                         const LanesVec3& wl, const LanesVec3& h) {
  Lanes sum = shares.diffuse / kPi * larger(wl.z, 0.0f) + shares.specular * pdf_ggx_reflection(wv, h, layers.alpha);
  if (shares.coat > 0) sum = sum + shares.coat * pdf_ggx_reflection(wv, h, layers.coat_alpha);
  return sum;
}

void eval_principled_simd(const PrincipledLobes& lobes, const PrincipledLobes::View& view,
                          const PrincipledShares& shares, const DirectionBatch& batch, RgbBatch& f, ScalarBatch& pdf) {
  const PrincipledLobes::Layers layers = lobes.layers();
  const Rgb color = lobes.parameters().base_color, tint = lobes.parameters().specular_tint;
  float* const channels[] = {f.r, f.g, f.b};
  for (int at = 0; at < batch.count; at += kLanes) {
    const LanesVec3 wl = load_directions(batch, at), h = half_vector(view.wv, wl);
    const auto parts = principled_parts(layers, view, wl, h);
    for (int c = 0; c < 3; ++c) {
      store_lanes(select(wl.z > 0.0f, principled_value(parts, color[c], tint[c]), 0.0f), channels[c] + at);
    }
    store_lanes(density(layers, shares, view.wv, wl, h), pdf.v + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "sphere/warp.h"

namespace velour {

HWY_EXPORT(eval_principled_simd);

namespace {

enum Parameter { kDiffuseScale, kThrough, kDiffuseEnd, kSpecularEnd };  // ends of ranges of the random number

Vec3 draw(const PrincipledLobes& lobes, const PreparedBrdf& point, const Vec2& u) {
  const float diffuse = point.parameter[kDiffuseEnd], end = point.parameter[kSpecularEnd];
  if (u.x < diffuse) return sample_cosine_hemisphere({u.x / diffuse, u.y});
  const bool coat = u.x >= end;
  const float first = coat ? end : diffuse, last = coat ? 1 : end;
  const float rest = std::min((u.x - first) / (last - first), 1 - 0x1p-24f);
  const Vec3 h = sample_ggx_visible_normal(point.wv, coat ? lobes.coat_alpha() : lobes.alpha(), {rest, u.y});
  return 2 * glm::dot(point.wv, h) * h - point.wv;
}

}  // namespace

void PrincipledSampling::set_up(const PrincipledLobes& lobes, const PrincipledLobes::View& view, float specular,
                                PreparedBrdf& point) {
  point.wv = view.wv;
  const float diffuse = luminance(lobes.parameters().base_color) * lobes.base_albedo(view);
  const float coat = lobes.coat_albedo(view.wv.z), total = diffuse + specular + coat;
  point.parameter[kDiffuseScale] = view.diffuse_scale;
  point.parameter[kThrough] = view.through;
  point.parameter[kDiffuseEnd] = total > 0 ? diffuse / total : 1;
  point.parameter[kSpecularEnd] = coat > 0 ? (diffuse + specular) / total : 1;
}

void PrincipledSampling::eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f,
                              ScalarBatch& pdf) const {
  eval_parts(point, point.parameter[kDiffuseScale], wl, f, pdf);
}

void PrincipledSampling::eval_specular(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f) const {
  ScalarBatch pdf;
  eval_parts(point, 0, wl, f, pdf);
}

void PrincipledSampling::eval_parts(const PreparedBrdf& point, float diffuse_scale, const DirectionBatch& wl,
                                    RgbBatch& f, ScalarBatch& pdf) const {
  const PrincipledLobes::View view{point.wv, diffuse_scale, point.parameter[kThrough]};
  const float diffuse = point.parameter[kDiffuseEnd], end = point.parameter[kSpecularEnd];
  const PrincipledShares shares{diffuse, end - diffuse, 1 - end};
  VELOUR_SIMD_DISPATCH(eval_principled_simd)(lobes(point), view, shares, wl, f, pdf);
}

void PrincipledSampling::sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const {
  const PrincipledLobes& here = lobes(point);
  wl.fill(u, [&](const Vec2& v) { return draw(here, point, v); });
}

}  // namespace velour
#endif
