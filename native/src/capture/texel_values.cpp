#include "capture/texel_values.h"

#include <algorithm>
#include <cmath>

#include "render/onward.h"

namespace velour {

TexelShader::TexelShader(const Scene& scene, const TexelSampling& sampling)
    : sampling_(sampling),
      rec709_to_working_(scene.rec709_to_working()),
      luminance_weights_(luminance({1, 0, 0}), luminance({0, 1, 0}), luminance({0, 0, 1})) {
  if (rec709_to_working_) luminance_weights_ = luminance_weights_ * glm::inverse(*rec709_to_working_);
}

Rgb TexelValues::mean(uint32_t light) const {
  const double scale = 1.0 / samples;
  return Rgb(Vec3d(sums.sum[0][light], sums.sum[1][light], sums.sum[2][light]) * scale);
}

float TexelValues::standard_error(uint32_t light) const {
  if (samples < 2) return 0;
  const double n = samples, mean = sums.luminance[light] / n;
  const double variance = std::max(0.0, sums.luminance_sq[light] / n - mean * mean) * n / (n - 1);
  return static_cast<float>(std::sqrt(variance / n));
}

void TexelShader::shade(const PathVertices& paths, uint32_t texel, const LightGroup& group, const ShadowMasks& masks,
                        TexelValues& values) {
  values = {};
  values.samples = sampling_.samples;
  const uint32_t padded = (group.count() + 15) / 16 * 16;  // what add_path() reads
  for (uint32_t s = 0; s < sampling_.samples; ++s) {
    for (auto& channel : path_) std::fill_n(channel, padded, 0.0f);
    shade_path(paths, texel * sampling_.samples + s, group, masks);
    values.broken += add_path(path_, luminance_weights_, group.count(), values.sums);
  }
}

void TexelShader::shade_path(const PathVertices& paths, uint32_t path, const LightGroup& group,
                             const ShadowMasks& masks) {
  for (uint32_t depth = 0; depth <= sampling_.bounces; ++depth) {
    const uint32_t v = paths.vertex_of(path, depth);
    if (v == PathVertices::kNone) return;
    shade_vertex(paths.vertices()[v], group, masks.of(v));
  }
}

void TexelShader::shade_vertex(const PathVertex& at, const LightGroup& group, const ShadowMasks::Mask& mask) {
  if ((mask[0] | mask[1]) == 0) return;
  at.vertex.surface->material->prepare(at.vertex.wv, at.vertex.site, prepared_);
  for (uint32_t word = 0; word < mask.size(); ++word) {
    if (mask[word] == 0) continue;
    collect_lit(group, 64 * word, mask[word], at.vertex.frame, lit_);
    add_lit(at);
  }
}

void TexelShader::add_lit(const PathVertex& at) {
  at.vertex.surface->material->eval(prepared_, lit_.wl, f_, pdf_);
  for (int i = 0; i < lit_.wl.count; ++i) {
    const Rgb f = in_working_space(rec709_to_working_, at.vertex, f_.get(i));
    const Rgb value = at.throughput * f * lit_.weight[i];
    for (int c = 0; c < 3; ++c) path_[c][lit_.number[i]] += value[c];
  }
}

}  // namespace velour
