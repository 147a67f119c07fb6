// Directions of several vertices whose light is still to be looked up, side by side.
#pragma once

#include <vector>

#include "render/combination.h"
#include "render/lighting.h"
#include "sphere/direction_batch.h"

namespace velour {

/// What each direction brings is  reflected x radiance / d,  d the density of combination.h. Looked up for a batch at
/// once, so that the sky's texels of all are on their way together and vectors are full.
///
/// Directions that are aimed at surfaces that glow bring their light alone, those that the lights draw otherwise bring
/// none of it, and the others bring both: each kind of light is weighed with the densities of those that bring it, the
/// environment by the `heuristic` that is chosen, lamps and surfaces by kLampHeuristic.
struct alignas(64) LightTerms {
  DirectionBatch world;
  RgbBatch reflected;            // throughput f cos / n of n directions
  ScalarBatch product, surface;  // share of a drawer times its density
  ScalarBatch light_share;
  Drawer drawer[DirectionBatch::kCapacity];     // who drew it
  uint8_t receiver[DirectionBatch::kCapacity];  // number of the vertex in the batch
  uint8_t aim[DirectionBatch::kCapacity];       // 0: none; else 1 + its number among the aims (Lighting::sample)

  // What look_up() finds.
  RgbBatch environment;             // radiance
  ScalarBatch weight, lamp_weight;  // 1 / d: of the environment, and of lamps where one is met
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
  /// `views`: by number of the vertex.
  void look_up(const Lighting& lighting, std::span<const LightView> views, Heuristic heuristic);
  /// `rays`: along the directions, as they leave their vertices.
  void look_up_glow(const Lighting& lighting, std::span<const LightView> views, std::span<const Hit> aims,
                    std::span<const Ray> rays);

 private:
  /// 1 / d, with the density of whoever draws towards the light.
  float weighed(Heuristic heuristic, int direction, float light_pdf) const;
  void find_glow(const GlowingSurfaces& surfaces, std::span<const Hit> aims, std::span<const Ray> rays);
  std::vector<GlowHit> found_;
};

}  // namespace velour
