// Directions of several vertices whose light is still to be looked up, side by side.
#pragma once

#include <vector>

#include "render/combination.h"
#include "render/lighting.h"
#include "sphere/direction_batch.h"

namespace velour {

/// What each direction brings is  reflected x radiance / d,  d the density of combination.h. Looked up for a batch at
/// once, so that the sky's texels of all are on their way together and vectors are full.
struct alignas(64) LightTerms {
  DirectionBatch world;
  RgbBatch reflected;            // throughput f cos / n of n directions
  ScalarBatch product, surface;  // share of a drawer times its density
  ScalarBatch light_share;
  Vec3 position[DirectionBatch::kCapacity];     // of the vertex
  Drawer drawer[DirectionBatch::kCapacity];     // who drew it
  uint8_t receiver[DirectionBatch::kCapacity];  // number of the vertex in the batch

  // What look_up() finds.
  RgbBatch environment;  // radiance
  ScalarBatch weight;    // 1 / d
  std::vector<LampHit> lamp_hits;

  void clear() {
    world.count = 0;
    lamp_hits.clear();
  }
  void look_up(const Lighting& lighting, Heuristic heuristic);
};

}  // namespace velour
