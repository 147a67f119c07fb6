// Patches of directions over a hemisphere in rings, as Klems's ([Kle94]) and others of BSDF XML files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sphere/vec.h"

namespace velour {

class KlemsBasis {
 public:
  /// Patches of a ring have the same sides; the first lies about azimuth 0.
  struct Ring {
    double least_theta, most_theta;  // degrees from the normal
    uint32_t patches;
  };
  struct Weighed {
    uint32_t patch;
    float weight;
  };

  /// Rings from the normal to the horizon, without gaps; at least one patch each.
  explicit KlemsBasis(const std::vector<Ring>& rings);

  /// Full, Half and Quarter, by their names in files ("LBNL/Klems Full"); nullptr: none of them.
  static const KlemsBasis* standard(const std::string& name);

  uint32_t patches() const { return patches_; }

  /// The centres of up to four patches about a unit direction of the upper hemisphere, with weights that add up to 1:
  /// linear in the angle from the normal between rings, and in azimuth along each.
  std::array<Weighed, 4> around(const Vec3& w) const;

 private:
  struct Placed {
    float center;  // radians from the normal
    uint32_t first, patches;
  };
  std::vector<Placed> rings_;
  uint32_t patches_ = 0;
};

}  // namespace velour
