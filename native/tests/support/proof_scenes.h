// Five scenes in which every strategy must have the same expectation. All have real lobes on every surface that can
// bear them, so that `product` has something to multiply.
#pragma once

#include "scene/scene.h"

namespace velour::test {

/// What a negative control changes: all light, or the density that every material claims, by a factor.
struct SceneError {
  float light = 1, density = 1;
};

enum class ProofScene { sphere_under_sun, sphere_under_wide_sun, metal_under_lamps, furnace, corner, two_bounces };

/// Radiance of the furnace, from everywhere.
inline const Rgb kFurnace(1, 0.8f, 0.5f);

/// Committed. The suns hold nine tenths of their skies' energy and are half a degree and 40 degrees across.
Scene proof_scene(ProofScene kind, const SceneError& error = {});

}  // namespace velour::test
