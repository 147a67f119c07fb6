#include "capture/texel_values.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/onward.h"

namespace velour {
namespace {

void add_path(const float (&path)[3][kLightsTogether], const Vec3& weights, uint32_t lights, TexelValues& values) {
  for (uint32_t l = 0; l < lights; ++l) {
    const float y = weights.r * path[0][l] + weights.g * path[1][l] + weights.b * path[2][l];
    const bool good = std::isfinite(y);
    for (int c = 0; c < 3; ++c) values.sum[c][l] += good ? static_cast<double>(path[c][l]) : 0.0;
    const double luminance = good ? static_cast<double>(y) : 0.0;
    values.luminance_sum[l] += luminance;
    values.luminance_sq[l] += luminance * luminance;
    values.broken += good ? 0 : 1;
  }
}

}  // namespace

TexelShader::TexelShader(const Scene& scene, const TexelSampling& sampling)
    : sampling_(sampling),
      rec709_to_working_(scene.rec709_to_working()),
      luminance_weights_(luminance({1, 0, 0}), luminance({0, 1, 0}), luminance({0, 0, 1})) {
  if (rec709_to_working_) luminance_weights_ = luminance_weights_ * glm::inverse(*rec709_to_working_);
}

Rgb TexelValues::mean(uint32_t light) const {
  const double scale = 1.0 / samples;
  return Rgb(Vec3d(sum[0][light], sum[1][light], sum[2][light]) * scale);
}

float TexelValues::standard_error(uint32_t light) const {
  if (samples < 2) return 0;
  const double n = samples, mean = luminance_sum[light] / n;
  const double variance = std::max(0.0, luminance_sq[light] / n - mean * mean) * n / (n - 1);
  return static_cast<float>(std::sqrt(variance / n));
}

void TexelShader::shade(const PathVertices& paths, uint32_t texel, std::span<const CaptureLight> lights,
                        const ShadowMasks& masks, TexelValues& values) {
  values = {};
  values.samples = sampling_.samples;
  for (uint32_t s = 0; s < sampling_.samples; ++s) {
    for (auto& channel : path_) std::fill_n(channel, lights.size(), 0.0f);
    shade_path(paths, texel * sampling_.samples + s, lights, masks);
    add_path(path_, luminance_weights_, static_cast<uint32_t>(lights.size()), values);
  }
}

void TexelShader::shade_path(const PathVertices& paths, uint32_t path, std::span<const CaptureLight> lights,
                             const ShadowMasks& masks) {
  for (uint32_t depth = 0; depth <= sampling_.bounces; ++depth) {
    const uint32_t v = paths.vertex_of(path, depth);
    if (v == PathVertices::kNone) return;
    shade_vertex(paths.vertices()[v], lights, masks.of(v));
  }
}

void TexelShader::shade_vertex(const PathVertex& at, std::span<const CaptureLight> lights,
                               const ShadowMasks::Mask& mask) {
  if ((mask[0] | mask[1]) == 0) return;
  at.vertex.surface->material->prepare(at.vertex.wv, at.vertex.site, prepared_);
  wl_.count = 0;
  for (uint32_t word = 0; word < mask.size(); ++word) {
    for (uint64_t bits = mask[word]; bits != 0; bits &= bits - 1) {
      const uint32_t light = 64 * word + static_cast<uint32_t>(std::countr_zero(bits));
      light_of_[wl_.count] = light;
      wl_.push(at.vertex.frame.to_local(lights[light].wl));
      if (wl_.count == DirectionBatch::kCapacity) add_batch(at, lights);
    }
  }
  if (wl_.count > 0) add_batch(at, lights);
}

void TexelShader::add_batch(const PathVertex& at, std::span<const CaptureLight> lights) {
  wl_.pad();
  at.vertex.surface->material->eval(prepared_, wl_, f_, pdf_);
  for (int i = 0; i < wl_.count; ++i) {
    const uint32_t light = light_of_[i];
    const Rgb f = in_working_space(rec709_to_working_, at.vertex, f_.get(i));
    const Rgb value = at.throughput * f * (wl_.z[i] * lights[light].per_irradiance);
    for (int c = 0; c < 3; ++c) path_[c][light] += value[c];
  }
  wl_.count = 0;
}

}  // namespace velour
