// A hemisphere of directions divided into rings of patches: the bases of Klems ([Kle94]) and others in BSDF XML files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

class KlemsBasis {
 public:
  /// Patches of a ring have the same size; the first is centered at azimuth 0.
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

  /// Klems Full, Half or Quarter by its name in files ("LBNL/Klems Full"); nullptr for other names.
  static const KlemsBasis* standard(const std::string& name);

  uint32_t patches() const { return patches_; }

  /// Up to four patches whose centers surround a unit direction of the upper hemisphere, with weights that add up to 1:
  /// linear in the angle from the normal between rings, and in azimuth along each ring.
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
