// Materials of known highlights for the proofs of samplers and strategies.
#pragma once

#include "brdf/eval/per_view_material.h"
#include "math/srbf/kernel.h"
#include "support/materials.h"
#include "support/sampler_proof.h"

namespace velour::test {

/// The material's sampler for one view; `interpolated`: PrepareOptions::interpolated_draws.
inline Sampler material_sampler(std::shared_ptr<const Material> material, const Vec3& wv,
                                const SurfaceSite& site = SurfaceSite::everywhere(), bool interpolated = false) {
  const auto arena = std::make_shared<ScratchArena>();
  const PreparedBrdf* const point = material->prepare(wv, site, {.interpolated_draws = interpolated}, *arena);
  return {[material, arena, point](const Vec2& u) { return point->sample_one(u); },
          [material, arena, point](const Vec3& wl) { return static_cast<double>(eval_one(*point, wl).pdf); }};
}

/// A highlight of albedo 1/2 about each view's mirror direction, whatever its bandwidth, over a broad lobe and a
/// diffuse base.
inline PerViewBrdf highlight_model(Kernel kernel, float bandwidth, const std::vector<Vec3>& views, bool isotropic) {
  PerViewBrdf brdf;
  brdf.kernel = kernel;
  brdf.isotropic = isotropic;
  brdf.default_neighbors = PerViewBrdf::usual_neighbors(isotropic);
  brdf.views = views;
  brdf.first_lobe = {0};
  const auto add = [&](const Vec3& center, float b, const Rgb& albedo) {
    brdf.center.push_back(glm::normalize(center));
    brdf.bandwidth.push_back(b);
    brdf.coefficient.push_back(albedo / static_cast<float>(kernel_integral(kernel, static_cast<double>(b))));
  };
  for (const Vec3& v : views) {
    add({-v.x, -v.y, v.z}, bandwidth, {0.6f, 0.5f, 0.3f});
    add({-0.3f * v.x, -0.3f * v.y, 1}, kernel == Kernel::gaussian ? 4 : 0.5f, {0.1f, 0.15f, 0.2f});
    brdf.diffuse.emplace_back(0.03f, 0.03f, 0.04f);
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  return brdf;
}

inline std::shared_ptr<const Material> highlight_material(float bandwidth) {
  return make_per_view_material(
      std::make_shared<PerViewBrdf>(highlight_model(Kernel::gaussian, bandwidth, meridian_views(), true)), 0);
}

/// A measurement with a closed form: a Lambertian base and a broad lobe about the mirror direction, not reciprocal.
class SyntheticMeasurement final : public Measurement {
 public:
  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    for (size_t i = 0; i < wl.size(); ++i) {
      valid[i] = wl[i].z > 0;
      const float lobe = std::pow(std::max(glm::dot(wl[i], mirror(wv)), 0.0f), 20.0f);
      f[i] = valid[i] ? Rgb(0.1f, 0.2f, 0.3f) + wv.z * lobe : Rgb(0);
    }
  }
  bool isotropic() const override { return true; }
  bool covers_view(float) const override { return true; }
};

/// A raw measurement whose samples come from `proposal`.
inline std::shared_ptr<const Material> measured(const PerViewBrdf& proposal) {
  return make_measured_material(std::make_shared<SyntheticMeasurement>(), std::make_shared<PerViewBrdf>(proposal), 0);
}

/// A kind of material whose samples come from lobes: a per-view model, or a measurement sampled by one.
struct LobeMaterial {
  const char* name;
  std::vector<float> bandwidths;
  PerViewBrdf (*model)(float bandwidth);
  bool is_measured = false;

  std::shared_ptr<const Material> make(float bandwidth) const {
    if (is_measured) return measured(model(bandwidth));
    return make_per_view_material(std::make_shared<PerViewBrdf>(model(bandwidth)), 0);
  }
};

inline PerViewBrdf gaussian_highlight(float bandwidth) {
  return highlight_model(Kernel::gaussian, bandwidth, meridian_views(), true);
}

inline const std::vector<LobeMaterial> kLobeMaterials = {
    {"isotropic gaussian", {1e-4f, 0.1f, 10, 1e3f, 1e5f, 1e6f}, gaussian_highlight},
    {"isotropic abel-poisson",
     {1e-4f, 0.5f, 0.9f, 0.999f},
     [](float b) { return highlight_model(Kernel::abel_poisson, b, meridian_views(), true); }},
    {"anisotropic gaussian",
     {1, 1e3f, 1e6f},
     [](float b) { return highlight_model(Kernel::gaussian, b, hemisphere_fibonacci(150), false); }},
    {"measured, proposal of lobes", {10, 1e5f}, gaussian_highlight, true}};

}  // namespace velour::test
