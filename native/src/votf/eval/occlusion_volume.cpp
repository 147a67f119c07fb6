#include "votf/eval/occlusion_volume.h"

#include <algorithm>
#include <cmath>

namespace velour {

uint8_t distance_byte(float share) {
  const float units = std::clamp(share, -1.0f, 1.0f) * VotfVolume::kUnits;
  return static_cast<uint8_t>(VotfVolume::kZero + static_cast<int>(std::lround(units)));
}

}  // namespace velour
