// Small scenes with known answers.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "material/material.h"
#include "math/sphere/warp.h"
#include "render/render.h"
#include "scene/scene.h"
#include "support/changed_material.h"

namespace velour::test {

/// f = albedo / pi.
class Lambert : public Material {
 public:
  explicit Lambert(float albedo) : albedo_(albedo) {}
  const PreparedBrdf* prepare(const Vec3& /*wv*/, const SurfaceSite& site, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<Prepared>(albedo(site));
  }
  bool isotropic() const override { return true; }

 protected:
  virtual float albedo(const SurfaceSite& /*site*/) const { return albedo_; }

 private:
  class Prepared final : public PreparedBrdf {
   public:
    explicit Prepared(float albedo) : albedo_(albedo) {}
    void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
      for (int i = 0; i < wl.count; ++i) {
        f.set(i, Rgb(wl.z[i] > 0 ? albedo_ / kPi : 0.0f));
        pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
      }
    }
    void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { wl.fill(u, sample_cosine_hemisphere); }

   private:
    float albedo_;
  };

  float albedo_;
};

/// Lambert that is there to a share of `alpha`.
class ThinLambert : public Lambert {
 public:
  ThinLambert(float albedo, float alpha) : Lambert(albedo), alpha_(alpha) {}
  float alpha(const SurfaceSite& /*site*/) const override { return alpha_; }

 private:
  float alpha_;
};

/// Lambert, but a third of its directions has a value that is not a number.
class BrokenLambert : public ChangedMaterial {
 public:
  explicit BrokenLambert(float albedo) : ChangedMaterial(std::make_shared<Lambert>(albedo), break_some) {}

 private:
  static void break_some(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& /*pdf*/) {
    for (int i = 0; i < wl.count; ++i) {
      if (wl.x[i] > 0.3f) f.g[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
};

/// Square of side 2 `half` in the plane z = 0 that faces +z.
inline Mesh square(float half) {
  const std::vector<Vec3> p = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  return Mesh({.positions = p, .triangles = t});
}

/// Unit sphere of 2 n^2 quads, outside in front.
inline Mesh sphere(uint32_t n) {
  std::vector<Vec3> p;
  std::vector<glm::uvec3> t;
  const float step = kPi / static_cast<float>(n);
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t j = 0; j <= 2 * n; ++j) {
      p.push_back(direction(static_cast<float>(i) * step, static_cast<float>(j) * step));
    }
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < 2 * n; ++j) {
      const uint32_t a = i * (2 * n + 1) + j, b = a + 2 * n + 1;
      if (i > 0) t.push_back({a, b, a + 1});
      if (i + 1 < n) t.push_back({a + 1, b, b + 1});
    }
  }
  return Mesh({.positions = p, .triangles = t});
}

inline Affine shift(const Vec3& by, const Vec3& scale = Vec3(1.0f)) {
  Affine a;
  for (int i = 0; i < 3; ++i) {
    a.m[5 * i] = scale[i];
    a.m[4 * i + 3] = by[i];
  }
  return a;
}

/// Looks down at the origin from z = 5; the picture spans about `half` metres to each side.
inline Camera camera_above(float half) {
  return Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 2 * std::atan(half / 5), 1);
}

inline RenderOptions small_options(Strategy strategy, int spp = 64) {
  RenderOptions o;
  o.width = o.height = 8;
  o.spp = spp;
  o.strategy = strategy;
  o.threads = 2;
  return o;
}

inline std::vector<float> rendered(const Scene& scene, const RenderOptions& options, const char* pass = "Combined",
                                   RenderReport* report = nullptr) {
  Film film(options.width, options.height);
  Progress progress;
  const RenderReport r = render(scene, options, film, progress);
  if (report != nullptr) *report = r;
  std::vector<float> pixels(static_cast<size_t>(options.width) * static_cast<size_t>(options.height) *
                            static_cast<size_t>(Film::channels(pass)));
  film.read_pass(pass, pixels);
  return pixels;
}

/// Mean of channel `channel` of a pass of `channels`.
inline double mean_of(const std::vector<float>& pixels, size_t channel = 0, size_t channels = 4) {
  double sum = 0;
  for (size_t i = channel; i < pixels.size(); i += channels) sum += pixels[i];
  return sum * static_cast<double>(channels) / static_cast<double>(pixels.size());
}

}  // namespace velour::test
