#include "material/principled_material.h"

#include <algorithm>

#include "material/ggx.h"
#include "sphere/warp.h"

namespace velour {

namespace {

/// Samples the cosine, the visible normals of the base's lobe or those of the coat's, in proportion to their albedos.
class PrincipledMaterial final : public Material {
 public:
  explicit PrincipledMaterial(const PrincipledParameters& p)
      : lobes_(p), specular_(lobes_.alpha(), [this](float cosine) { return lobes_.fresnel_luminance(cosine); }) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    const PrincipledLobes::View view = lobes_.view(point.wv = wv);
    const PrincipledParameters& p = lobes_.parameters();
    const float diffuse = luminance(p.base_color) * lobes_.base_albedo(view);
    const float specular = view.through * specular_.at(wv.z), coat = lobes_.coat_albedo(wv.z);
    const float total = diffuse + specular + coat;
    point.parameter[kDiffuseScale] = view.diffuse_scale;
    point.parameter[kThrough] = view.through;
    point.parameter[kDiffuseEnd] = total > 0 ? diffuse / total : 1;
    point.parameter[kSpecularEnd] = coat > 0 ? (diffuse + specular) / total : 1;
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    const PrincipledLobes::View view{point.wv, point.parameter[kDiffuseScale], point.parameter[kThrough]};
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 w = wl.get(i), sum = w + point.wv;
      const float length_sq = glm::dot(sum, sum);
      const Vec3 h = length_sq > 0 ? sum / std::sqrt(length_sq) : Vec3(0);  // opposed directions: no facet mirrors them
      f.set(i, w.z > 0 ? lobes_.value(lobes_.parts(view, w, h)) : Rgb(0));
      pdf.v[i] = density(point, w, h);
    }
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return sample_one(point, v); });
  }

  bool isotropic() const override { return true; }

 private:
  enum Parameter { kDiffuseScale, kThrough, kDiffuseEnd, kSpecularEnd };  // ends of ranges of the random number

  float density(const PreparedBrdf& point, const Vec3& wl, const Vec3& h) const {
    const float diffuse = point.parameter[kDiffuseEnd], end = point.parameter[kSpecularEnd];
    float sum = diffuse * pdf_cosine_hemisphere(wl) + (end - diffuse) * pdf_ggx_reflection(point.wv, h, lobes_.alpha());
    if (end < 1) sum += (1 - end) * pdf_ggx_reflection(point.wv, h, lobes_.coat_alpha());
    return sum;
  }

  Vec3 sample_one(const PreparedBrdf& point, const Vec2& u) const {
    const float diffuse = point.parameter[kDiffuseEnd], end = point.parameter[kSpecularEnd];
    if (u.x < diffuse) return sample_cosine_hemisphere({u.x / diffuse, u.y});
    const bool coat = u.x >= end;
    const float first = coat ? end : diffuse, last = coat ? 1 : end;
    const float rest = std::min((u.x - first) / (last - first), 1 - 0x1p-24f);
    const Vec3 h = sample_ggx_visible_normal(point.wv, coat ? lobes_.coat_alpha() : lobes_.alpha(), {rest, u.y});
    return 2 * glm::dot(point.wv, h) * h - point.wv;
  }

  PrincipledLobes lobes_;
  SpecularAlbedo specular_;  // of metal and dielectric, in luminance
};

}  // namespace

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters) {
  return std::make_shared<PrincipledMaterial>(parameters);
}

}  // namespace velour
