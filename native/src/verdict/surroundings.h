// The light that a verdict looks at a material in: three procedural environments, unlike any that a fit reads.
#pragma once

#include <array>
#include <vector>
#include "math/sphere/frame.h"

namespace velour {

/// A studio with softboxes, a clear sky with the sun, a street at night. Radiance without unit, since pictures are
/// exposed; +y is up. The finest level resolves 1.4 degrees, and others are averages, so that a direction that stands
/// for a solid angle gets the mean radiance about it.
class Surroundings {
 public:
  static constexpr size_t kCount = 3;
  /// Three channels of each environment and one of padding.
  using Radiance = std::array<float, 4 * kCount>;

  /// The directions from which a surface is lit, in its frame, and what two materials reflect from each. Radiance is
  /// interpolated between texels as large as the solid angle (sr) that a direction stands for.
  class Lights {
   public:
    /// `reflected`: f cos(theta_l) times the solid angle.
    void add(const Surroundings& surroundings, const Vec3& wl, double solid_angle, const std::array<Rgb, 2>& reflected);
    bool empty() const { return count_ == 0; }

   private:
    friend class Surroundings;
    static constexpr size_t kPadding = 16;  // lights per vector, at most; those that pad reflect nothing

    size_t count_ = 0;
    std::vector<float> x_, y_, z_;
    std::vector<float> first_, side_;  // first texel and side of the level
    std::vector<std::array<float, 8>> reflected_;
  };

  Surroundings();

  /// The radiance that each of the materials reflects in each environment.
  std::array<Radiance, 2> reflected(const Frame& surface, const Lights& lights) const;

 private:
  struct Level {
    int side;
    size_t first;
  };
  const Level& level_of(double solid_angle) const;

  std::vector<Level> levels_;
  std::vector<Radiance> texels_;  // octahedral maps [PH03], one level after the other
};

}  // namespace velour
