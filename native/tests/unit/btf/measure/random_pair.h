// Pairs of directions that evaluators are asked for.
#pragma once

#include "math/sphere/directions.h"
#include "math/sphere/random.h"

namespace velour::test {

inline DirectionPair random_pair(uint64_t i) {
  RandomStream random(11, i, 0);
  const Vec3 wl = direction(1.5f * random.next(), 2 * kPi * random.next());
  return {wl, direction(1.4f * random.next(), 2 * kPi * random.next())};
}

}  // namespace velour::test
