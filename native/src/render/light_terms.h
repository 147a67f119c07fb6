// Directions of several vertices whose light is looked up together.
#pragma once

#include <vector>

#include "render/combination.h"
#include "render/lighting.h"
#include "sphere/direction_batch.h"

namespace velour {

/// Each direction contributes  reflected x radiance / d,  with d the density of combination.h. Light is looked up for a
/// whole batch, so that all fetches of environment texels are in flight together and vectors are full.
///
/// Directions aimed at emissive meshes carry the light of these alone, other light-sampled directions carry none of it,
/// and the remaining ones carry both. Each kind of light is weighted with the densities of the techniques that carry
/// it: the environment by the chosen `heuristic`, lights and meshes by kLampHeuristic.
struct alignas(64) LightTerms {
  DirectionBatch world;
  RgbBatch reflected;            // throughput f cos / n of n directions
  ScalarBatch product, surface;  // share of a technique times its density
  ScalarBatch light_share;
  Drawer drawer[DirectionBatch::kCapacity];     // technique that sampled it
  uint8_t receiver[DirectionBatch::kCapacity];  // index of the vertex in the batch
  uint8_t aim[DirectionBatch::kCapacity];       // 0: none; otherwise 1 + index among the aims (Lighting::sample)

  // Results of look_up().
  RgbBatch environment;             // radiance
  ScalarBatch weight, lamp_weight;  // 1 / d: for the environment, and for lights where one is hit
  std::vector<LampHit> lamp_hits;
  struct Glow {
    int direction;
    Hit hit;
    float weight;  // 1 / d
  };
  std::vector<Glow> glow;

  void clear() {
    world.count = 0;
    lamp_hits.clear();
    glow.clear();
  }
  /// `views`: by index of the vertex.
  void look_up(const Lighting& lighting, std::span<const LightView> views, Heuristic heuristic);
  /// `rays`: along the directions, starting at their vertices.
  void look_up_glow(const Lighting& lighting, std::span<const LightView> views, std::span<const Hit> aims,
                    std::span<const Ray> rays);

 private:
  /// 1 / d, with the density of the technique that samples the light.
  float weighed(Heuristic heuristic, int direction, float light_pdf) const;
  void find_glow(const GlowingSurfaces& surfaces, std::span<const Hit> aims, std::span<const Ray> rays);
  std::vector<GlowHit> found_;
};

}  // namespace velour
