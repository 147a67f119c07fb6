// A BTF of clustered tensors with a highlight, for tests of what samples are drawn from.
#pragma once

#include "support/example_tensor.h"

namespace velour::test {

/// The factors of both directions are identities, so that a core is any table of views and lights: a base, and a
/// highlight of half vectors about a normal that leans by `lean` and fades with the light's cosine.
inline TensorBtfCluster glossy_cluster(const std::vector<Vec3>& views, const std::vector<Vec3>& lights, float bandwidth,
                                       float lean) {
  const Vec3 normal = direction(std::abs(lean), lean < 0 ? 1.0f : 3.0f);
  std::vector<float> view(views.size() * views.size()), light(lights.size() * lights.size()), base, highlight;
  for (size_t v = 0; v < views.size(); ++v) view[v * views.size() + v] = 1;
  for (size_t l = 0; l < lights.size(); ++l) light[l * lights.size() + l] = 1;
  for (const Vec3& wv : views) {
    for (const Vec3& wl : lights) {
      const float cosine = glm::dot(glm::normalize(wl + wv), normal);
      base.push_back(0.4f + 0.1f * wl.x);
      highlight.push_back(wl.z * std::exp(bandwidth * (cosine - 1)));
    }
  }
  std::vector<float> core = base;
  core.insert(core.end(), highlight.begin(), highlight.end());
  return {halves_of(view),
          halves_of(light),
          halves_of({1, 0.1f, -0.05f}),
          halves_of(core),
          {{0.4f, 0.3f / 255}, {0.6f, 0.8f / 255}}};
}

/// 6 x 4 texels of two clusters, one a texel; both sides, of which the lower one is the duller.
inline TensorBtf glossy_tensor() {
  std::vector<PolarAngles> directions{{0, 0}};
  for (const int theta : {18, 36, 54, 72}) {
    for (const PolarAngles& d : ring_directions(theta, theta / 3)) directions.push_back(d);
  }
  for (const PolarAngles& d : below(directions)) directions.push_back(d);
  TensorBtf btf{PairLayout(directions, directions), {6, 4, Vec2(0.002f, 0.003f)}, Companding::root, Mat3(1.0f), {}};
  for (const bool lower : {false, true}) {
    const std::vector<Vec3> set = directions_on_side(directions, lower);
    const auto count = static_cast<uint32_t>(set.size());
    TensorSide side = random_side(btf.layout, btf.grid, lower, {2, 1, {2, 1, 1, 1}, true});
    side.rank = {2, count, count, 1};
    const float bandwidth = lower ? 15.0f : 40.0f;
    side.clusters = {glossy_cluster(set, set, bandwidth, 0.1f), glossy_cluster(set, set, bandwidth, -0.2f)};
    btf.sides.push_back(side);
  }
  return btf;
}

}  // namespace velour::test
