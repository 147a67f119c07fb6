// Computes a texel's values from the vertices of its paths and the lights that reach them.
#pragma once

#include <optional>
#include <span>

#include "capture/light_kernels.h"
#include "capture/path_vertices.h"
#include "capture/shadow_masks.h"
#include "material/material.h"

namespace velour {

/// Sums over the samples of a texel for each light of a group.
struct TexelValues {
  PathSums sums;  // working space
  uint32_t samples;
  uint32_t broken;  // values that were not finite and count as 0

  Rgb mean(uint32_t light) const;  // working space
  /// Standard error of the mean's luminance, from the spread of the samples. An upper bound, because the samples are
  /// stratified. 0 for a single sample.
  float standard_error(uint32_t light) const;
};

/// One per thread.
class TexelShader {
 public:
  TexelShader(const Scene& scene, const TexelSampling& sampling);

  /// Computes the values of texel number `texel` of the block. `masks` must be those of `group`.
  void shade(const PathVertices& paths, uint32_t texel, const LightGroup& group, const ShadowMasks& masks,
             TexelValues& values);

 private:
  void shade_path(const PathVertices& paths, uint32_t path, const LightGroup& group, const ShadowMasks& masks);
  void shade_vertex(const PathVertex& at, const LightGroup& group, const ShadowMasks::Mask& mask);
  void add_lit(const PathVertex& at);

  const TexelSampling sampling_;
  const std::optional<Mat3>& rec709_to_working_;
  Vec3 luminance_weights_;  // for colors in the working space
  PreparedBrdf prepared_;
  LitLights lit_;  // of one vertex
  RgbBatch f_;
  ScalarBatch pdf_;
  alignas(64) float path_[3][kLightsTogether];  // contribution of each light along one path
};

}  // namespace velour
