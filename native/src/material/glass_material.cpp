#include "material/glass_material.h"

#include <algorithm>

#include "math/sphere/frame.h"
#include "math/sphere/warp.h"

namespace velour {
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
    p.roughness = textures_.roughness.at(site, p.roughness);
    p.refraction_roughness = textures_.roughness.at(site, p.refraction_roughness);
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
