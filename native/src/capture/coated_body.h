// The body below a facet of a clear surface: pigment, metal flakes, or both.
#pragma once

#include <optional>

#include "capture/periodic_tile.h"
#include "capture/reflectance.h"
#include "sphere/random.h"

namespace velour {

/// A clear dielectric over a body of pigment and flakes.
struct CoatedBody {
  double ior;                    // of the dielectric
  Reflectance flakes;            // of the flakes' metal below the dielectric
  double flake_roughness = 0.2;  // Beckmann alpha of the flakes' own slopes
  Rgb pigment_albedo{0, 0, 0};
  double pigment_share = 1.0;  // of the body's area

  bool has_flakes() const { return pigment_share < 1.0; }
};

/// Reflectance of the interface, from air.
Reflectance interface_of(const CoatedBody& body);

/// A random surface of flakes with patches of pigment, below a clear surface. The relief of both is small compared with
/// their distance and with each other's tiles, so light reaches a random point of this surface and leaves through the
/// facet that it entered by. Pigment alone is flat. Immutable after construction.
class BodyBelow {
 public:
  /// `stream` and `stream + 1`: random number streams of the surface, used by no other surface.
  BodyBelow(const CoatedBody& body, uint64_t seed, uint64_t stream);

  /// Follows light that has passed the interface until it leaves again; returns its direction in air, in the facet's
  /// frame. `arriving`: unit, back along the ray, in air, in the same frame. Multiplies `weight` by the remaining
  /// share; 0: nothing came out.
  Vec3 through(Vec3 arriving, Rgb& weight, RandomStream& random) const;

 private:
  Vec3 scatter(const Vec3& inside, Rgb& weight, RandomStream& random) const;

  CoatedBody body_;
  Reflectance interface_;
  std::optional<PeriodicTile> surface_;
};

}  // namespace velour
