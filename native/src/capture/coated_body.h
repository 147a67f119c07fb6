// What lies below a facet of a clear surface: pigment, metal flakes, or both.
#pragma once

#include <optional>

#include "capture/periodic_tile.h"
#include "capture/reflectance.h"
#include "sphere/random.h"

namespace velour {

/// A clear dielectric on a body of pigment and flakes.
struct CoatedBody {
  double ior;                    // of the dielectric
  Reflectance flakes;            // of the flakes' metal, below the dielectric
  double flake_roughness = 0.2;  // Beckmann alpha of the flakes' own slopes
  Rgb pigment_albedo{0, 0, 0};
  double pigment_share = 1.0;  // of the body's area

  bool has_flakes() const { return pigment_share < 1.0; }
};

/// What the interface reflects, from air.
Reflectance interface_of(const CoatedBody& body);

/// One random surface of flakes with patches of pigment, below a clear one; both are thin against their distance and
/// each other's tiles, so light comes to a place of this one by chance and leaves through the facet that it came in by.
/// Pigment alone is flat. Immutable after construction.
class BodyBelow {
 public:
  /// `stream` and `stream + 1` draw the surface; one that no other surface uses.
  BodyBelow(const CoatedBody& body, uint64_t seed, uint64_t stream);

  /// Follows light that the interface let in until it is out again. `arriving`: unit, back along the ray, in air, in
  /// the facet's frame. Multiplies `weight` by what is left; the light's direction in air, in the same frame. Weight 0:
  /// nothing came out.
  Vec3 through(Vec3 arriving, Rgb& weight, RandomStream& random) const;

 private:
  Vec3 scatter(const Vec3& inside, Rgb& weight, RandomStream& random) const;

  CoatedBody body_;
  Reflectance interface_;
  std::optional<PeriodicTile> surface_;
};

}  // namespace velour
