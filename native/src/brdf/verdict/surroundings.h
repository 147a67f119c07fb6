// The light that a verdict looks at a material in: three procedural environments, unlike any that a fit reads.
#pragma once

#include <array>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

/// A studio with softboxes, a clear sky with the sun, a street at night. Radiance without unit, since pictures are
/// exposed; +y is up. The finest level resolves 1.4 degrees, and others are averages, so that a direction that stands
/// for a solid angle gets the mean radiance about it.
class Surroundings {
 public:
  static constexpr int kCount = 3;
  /// Three channels of each environment and one of padding.
  using Radiance = std::array<float, 4 * kCount>;

  Surroundings();

  /// The level whose texels are as large as `solid_angle` (sr).
  int level_of(double solid_angle) const;
  /// Interpolates between the texels of a level.
  Radiance at(const Vec3& world, int level) const;

 private:
  struct Level {
    int side;
    std::vector<Radiance> texels;  // octahedral map [PH03]
  };
  std::vector<Level> levels_;
};

}  // namespace velour
