// Small models and one-direction calls for tests of materials.
#pragma once

#include "brdf/eval/table_sampler.h"
#include "brdf/model/per_view_brdf.h"
#include "material/material.h"
#include "math/sphere/directions.h"

namespace velour::test {

/// A colored highlight about each view's mirror direction over a broad lobe about the normal and a retro-reflecting
/// one.
inline PerViewBrdf glossy_model(Kernel kernel, const std::vector<Vec3>& views, bool isotropic, float sharp = 300) {
  PerViewBrdf brdf;
  brdf.kernel = kernel;
  brdf.isotropic = isotropic;
  brdf.default_neighbors = isotropic ? 2 : 4;
  brdf.views = views;
  brdf.first_lobe = {0};
  const bool gaussian = kernel == Kernel::gaussian;
  const float to_peak = gaussian ? 1.0f : 0.01f;  // the Abel-Poisson kernel is tall
  const auto add = [&](const Vec3& center, float bandwidth, const Rgb& coefficient) {
    brdf.center.push_back(glm::normalize(center));
    brdf.bandwidth.push_back(bandwidth);
    brdf.coefficient.push_back(coefficient);
  };
  for (const Vec3& v : views) {
    add({-v.x, -v.y, v.z + 0.02f}, gaussian ? sharp : 0.92f, to_peak * Rgb(5, 4, 2));
    add({0.1f * v.y, -0.1f * v.x, 1}, gaussian ? 2 : 0.5f, {0.1f, 0.05f, 0.2f});
    add({v.x, v.y, v.z + 0.2f}, gaussian ? 10 : 0.7f, to_peak * Rgb(0.2f));
    brdf.diffuse.emplace_back(0.03f, 0.02f, 0.01f);
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  return brdf;
}

/// Views every 5 degrees from the normal to 85 degrees.
inline std::vector<Vec3> meridian_views() {
  std::vector<Vec3> views;
  for (int i = 0; i <= 17; ++i) views.push_back(direction(radians_from(5.0f * static_cast<float>(i)), 0));
  return views;
}

inline PerViewBrdf isotropic_model(Kernel kernel = Kernel::gaussian) {
  return glossy_model(kernel, meridian_views(), true);
}

inline PerViewBrdf anisotropic_model() { return glossy_model(Kernel::gaussian, hemisphere_fibonacci(150), false); }

struct Evaluated {
  Rgb f;
  float pdf;
};

inline Evaluated eval_one(const PreparedBrdf& point, const Vec3& wl) {
  DirectionBatch batch;
  batch.push(wl);
  batch.pad();
  RgbBatch f;
  ScalarBatch pdf;
  point.eval(batch, f, pdf);
  return {f.get(0), pdf.v[0]};
}

inline Evaluated eval_one(const Material& material, const DirectionPair& w) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(w.wv, arena);
  return eval_one(*point, w.wl);
}

inline float pdf_one(const TableSampler& table, const DirectionPair& w) {
  DirectionBatch batch;
  batch.push(w.wl);
  batch.pad();
  ScalarBatch pdf;
  TablePoint point;
  table.prepare(w.wv, point);
  TableSampler::pdf(point, batch, pdf);
  return pdf.v[0];
}

inline Vec3 sample_one(const TableSampler& table, const Vec3& wv, const Vec2& u) {
  TablePoint point;
  table.prepare(wv, point);
  DirectionBatch wl;
  TableSampler::sample(point, {&u, 1}, wl);
  return wl.get(0);
}

inline Vec3 mirror(const Vec3& w) { return {-w.x, -w.y, w.z}; }

}  // namespace velour::test
