#include "material/bsdf_materials.h"

#include <algorithm>
#include <cmath>

#include "material/microfacet/ggx.h"
#include "material/principled/principled_material.h"
#include "math/sphere/frame.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

constexpr float kWhole = 0.5f * kPi - 2.0f / 3;  // uneven_albedo at the horizon

/// Integral over the hemisphere of light of s / t (see the header) times the cosine.
float uneven_albedo(float cosine) {
  if (cosine < 1e-6f) return kWhole - cosine;
  const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
  return sine * (std::acos(std::min(cosine, 1.0f)) - 2.0f / 3 - sine * cosine) +
         2.0f / 3 * (sine / cosine) * (1 - sine * sine * sine);
}
constexpr float kMeanUnevenAlbedo = (2 * kPi - 5.6f) / 3;  // cosine-weighted

class PreparedRoughDiffuse final : public PreparedBrdf {
 public:
  PreparedRoughDiffuse(const RoughDiffuseParameters& p, const Vec3& wv, const SurfaceSite& site)
      : wv_(wv), color_(glm::max(p.color_texture.at(site, p.color), Rgb(0.0f))) {
    const float roughness = std::clamp(p.roughness_texture.at_point(site, p.roughness), 0.0f, 1.0f);
    even_ = 1 / (kPi + kWhole * roughness);
    uneven_ = roughness * even_;
    many_ = p.interreflection && roughness > 0 ? interreflected() : Rgb(0.0f);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    const bool any = many_ != Rgb(0.0f);
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i);
      float s = wv_.x * l.x + wv_.y * l.y;
      if (s > 0) s /= std::max(wv_.z, l.z);
      Rgb value = color_ * (even_ + uneven_ * s);
      if (any) value += many_ * one_minus_albedo(uneven_albedo(l.z));
      f.set(i, l.z > 0 ? value : Rgb(0.0f));
      pdf.v[i] = std::max(l.z, 0.0f) / kPi;
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { wl.fill(u, sample_cosine_hemisphere); }

 private:
  /// 1 - E of a white surface. A pi + B (pi/2 - 2/3) is 1, so a nearly smooth surface causes no cancellation.
  float one_minus_albedo(float uneven) const { return uneven_ * (kWhole - uneven); }

  /// Factor of the interreflection lobe that does not depend on the light.
  Rgb interreflected() const {
    const float lost = one_minus_albedo(kMeanUnevenAlbedo);                                // 1 - m
    const float of_mean = (kWhole - uneven_albedo(wv_.z)) / (kWhole - kMeanUnevenAlbedo);  // (1 - E) / (1 - m)
    const Rgb between = glm::min(color_, Rgb(1.0f));  // the series of reflections converges
    return color_ * between * between * ((1 - lost) * of_mean / kPi) / (1.0f - between * lost);
  }

  Vec3 wv_;
  Rgb color_, many_;
  float even_, uneven_;  // A and B of the header
};

class RoughDiffuseMaterial final : public Material {
 public:
  explicit RoughDiffuseMaterial(const RoughDiffuseParameters& p) : p_(p) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<PreparedRoughDiffuse>(p_, wv, site);
  }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  const RoughDiffuseParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_rough_diffuse_material(const RoughDiffuseParameters& parameters) {
  return std::make_shared<RoughDiffuseMaterial>(parameters);
}

namespace {

class PreparedGlossy final : public PreparedBrdf {
 public:
  PreparedGlossy(const GlossyParameters& p, const Vec3& wv, const SurfaceSite& site, const LobeFilter& filter)
      : wv_(wv), lobe_(p.lobe) {
    const Rgb given = glm::max(p.color_texture.at(site, p.color), Rgb(0.0f));
    const Rgb color = filter.diffuse_only ? Rgb(0.0f) : given;
    const float roughness = std::clamp(p.roughness_texture.at_point(site, p.roughness), kMinRoughness, 1.0f);
    color_ = color * Interreflection(p.lobe, roughness, wv.z).gain(glm::min(color, Rgb(1.0f)));
    alpha_ = Vec2(std::max(roughness * roughness, filter.min_alpha));
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i), h = half_vector(wv_, l);
      f.set(i, l.z > 0 ? color_ * lobe(l, h) : Rgb(0.0f));
      pdf.v[i] = pdf_ggx_reflection(wv_, h, alpha_);
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) {
      const Vec3 h = sample_ggx_visible_normal(wv_, alpha_, v);
      return 2 * glm::dot(wv_, h) * h - wv_;
    });
  }

  float diffuse_share(const Vec3& /*wl*/, float /*pdf*/) const override { return 0; }

 private:
  float lobe(const Vec3& wl, const Vec3& h) const {
    return lobe_ == GgxLobe::separable ? ggx_brdf_of_independent_shadows(wv_, wl, h, alpha_)
                                       : ggx_brdf_without_fresnel(wv_, wl, h, alpha_);
  }

  Vec3 wv_;
  GgxLobe lobe_;
  Rgb color_;
  Vec2 alpha_;
};

class GlossyMaterial final : public Material {
 public:
  explicit GlossyMaterial(const GlossyParameters& p) : p_(p) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    return arena.make<PreparedGlossy>(p_, wv, site, options.filter);
  }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  const GlossyParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters) {
  return std::make_shared<GlossyMaterial>(parameters);
}

namespace {

class PreparedGlass final : public PreparedBrdf {
 public:
  PreparedGlass(const GlassParameters& p, const Vec3& wv, bool back, const PrepareOptions& options)
      : lobe_(p, wv, back, options) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      const Reflection value = lobe_.eval(wl.get(i));
      f.set(i, value.f);
      pdf.v[i] = value.pdf;
    }
  }
  Reflection eval_one(const Vec3& wl) const override { return lobe_.eval(wl); }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return lobe_.sample(v); });
  }

  void delta_lobes(DeltaLobes& lobes) const override {
    lobes.count = 0;
    lobes.rest = lobe_.albedo();
    lobe_.add_deltas(Rgb(1.0f), lobes);
  }

  float diffuse_share(const Vec3& /*wl*/, float /*pdf*/) const override { return 0; }

 private:
  GlassLobe lobe_;
};

class GlassMaterial final : public Material {
 public:
  GlassMaterial(const GlassParameters& p, const GlassTextures& textures) : p_(p), textures_(textures) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    GlassParameters p = p_;
    p.roughness = textures_.roughness.at_point(site, p.roughness);
    p.refraction_roughness = textures_.roughness.at_point(site, p.refraction_roughness);
    p.reflected = glm::max(textures_.color.at(site, p.reflected), Rgb(0.0f));
    p.refracted = glm::max(textures_.color.at(site, p.refracted), Rgb(0.0f));
    return arena.make<PreparedGlass>(p, wv, site.back, options);
  }

  bool transmits() const override { return true; }
  bool varies() const override { return textures_.color.given() || textures_.roughness.given(); }
  bool isotropic() const override { return true; }

 private:
  const GlassParameters p_;
  const GlassTextures textures_;
};

class PreparedTranslucent final : public PreparedBrdf {
 public:
  explicit PreparedTranslucent(const Rgb& color) : f_(color / kPi) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, wl.z[i] < 0 ? f_ : Rgb(0.0f));
      pdf.v[i] = std::max(-wl.z[i], 0.0f) / kPi;
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [](const Vec2& v) { return mirrored(sample_cosine_hemisphere(v)); });
  }

 private:
  Rgb f_;
};

class TranslucentMaterial final : public Material {
 public:
  TranslucentMaterial(const Rgb& color, const TextureSlot<Rgb>& texture) : color_(color), texture_(texture) {}

  const PreparedBrdf* prepare(const Vec3& /*wv*/, const SurfaceSite& site, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<PreparedTranslucent>(glm::max(texture_.at(site, color_), Rgb(0.0f)));
  }

  bool transmits() const override { return true; }
  bool varies() const override { return texture_.given(); }
  bool isotropic() const override { return true; }

 private:
  const Rgb color_;
  const TextureSlot<Rgb> texture_;
};

}  // namespace

std::shared_ptr<const Material> make_glass_material(const GlassParameters& parameters, const GlassTextures& textures) {
  return std::make_shared<GlassMaterial>(parameters, textures);
}

std::shared_ptr<const Material> make_translucent_material(const Rgb& color, const TextureSlot<Rgb>& texture) {
  return std::make_shared<TranslucentMaterial>(color, texture);
}

}  // namespace velour
