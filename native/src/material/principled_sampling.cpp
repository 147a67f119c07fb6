#include "material/principled_sampling.h"

#include <algorithm>

#include "material/ggx.h"
#include "sphere/warp.h"

namespace velour {
namespace {

enum Parameter { kDiffuseScale, kThrough, kDiffuseEnd, kSpecularEnd };  // ends of ranges of the random number

float density(const PrincipledLobes& lobes, const PreparedBrdf& point, const Vec3& wl, const Vec3& h) {
  const float diffuse = point.parameter[kDiffuseEnd], end = point.parameter[kSpecularEnd];
  float sum = diffuse * pdf_cosine_hemisphere(wl) + (end - diffuse) * pdf_ggx_reflection(point.wv, h, lobes.alpha());
  if (end < 1) sum += (1 - end) * pdf_ggx_reflection(point.wv, h, lobes.coat_alpha());
  return sum;
}

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
  const PrincipledLobes& here = lobes(point);
  const PrincipledLobes::View view{point.wv, point.parameter[kDiffuseScale], point.parameter[kThrough]};
  for (int i = 0; i < wl.count; ++i) {
    const Vec3 w = wl.get(i), sum = w + point.wv;
    const float length_sq = glm::dot(sum, sum);
    const Vec3 h = length_sq > 0 ? sum / std::sqrt(length_sq) : Vec3(0);  // opposed directions: no facet mirrors them
    f.set(i, w.z > 0 ? here.value(here.parts(view, w, h)) : Rgb(0));
    pdf.v[i] = density(here, point, w, h);
  }
}

void PrincipledSampling::sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const {
  const PrincipledLobes& here = lobes(point);
  wl.fill(u, [&](const Vec2& v) { return draw(here, point, v); });
}

}  // namespace velour
