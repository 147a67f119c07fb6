// Pairs of view and light: their order in a BTF, interpolation between them, and held-out pairs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "base/warning.h"
#include "math/sphere/direction_mesh.h"
#include "math/sphere/vec.h"

namespace velour {

// The pairs of directions of a BTF and the order of its images.

// Directions as polar angles in degrees, the convention of measurements.

/// In degrees. `theta`: from the normal of the reference plane, 0..180 (above 90: below the plane); `phi`: from +x
/// towards +y.
struct PolarAngles {
  double theta = 0, phi = 0;
  bool operator==(const PolarAngles&) const = default;
};

/// The unit vector of a direction. All conversions use this function, so that equal angles give equal bits. Multiples
/// of 90 degrees are exact: a direction in the plane has z = 0.
Vec3 unit_direction(const PolarAngles& angles);

/// A ring of `count` directions at `theta`, the first at phi = 0.
std::vector<PolarAngles> ring_directions(double theta, int count);

/// The 81 directions of the Bonn sets (UBO2003): rings of 1, 6, 12, 18, 20, 24 at 0, 15 ... 75 degrees.
std::vector<PolarAngles> bonn_directions();
/// The Bonn directions and a ring of 24 at 85 degrees. Used by captures, because surfaces are seen up to the horizon.
std::vector<PolarAngles> capture_directions();
/// `count` directions of equal solid angle over the upper hemisphere (hemisphere_fibonacci).
std::vector<PolarAngles> even_directions(int count);
/// The mirror images of `directions` below the plane.
std::vector<PolarAngles> below(const std::vector<PolarAngles>& directions);
/// The directions of a set on one side of the plane, in order, as unit vectors mirrored to z > 0.
std::vector<Vec3> directions_on_side(const std::vector<PolarAngles>& set, bool below);

/// Pairs are numbered by view, then by light.
class PairLayout {
 public:
  /// Pairs every view with every light. Throws Error(invalid_argument) if a set is empty, or contains a direction that
  /// is repeated, not finite, or within 0.1 degrees of the plane.
  PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights);
  /// `lights_of_view[v]`: indices of the lights paired with view v, ascending; may be empty.
  PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights,
             const std::vector<std::vector<uint32_t>>& lights_of_view);

  const std::vector<PolarAngles>& views() const { return views_; }
  const std::vector<PolarAngles>& lights() const { return lights_; }
  uint64_t pairs() const { return light_of_pair_.size(); }
  /// Pairs of view v are numbered [first(v), first(v + 1)).
  uint64_t first(size_t view) const { return first_[view]; }
  uint32_t light_of(uint64_t pair) const { return light_of_pair_[pair]; }
  uint32_t view_of(uint64_t pair) const;
  /// Whether every view has every light.
  bool complete() const { return pairs() == views_.size() * lights_.size(); }
  /// Unit vectors of a pair.
  DirectionPair directions(uint64_t pair) const;

  bool operator==(const PairLayout&) const = default;

 private:
  void check() const;

  std::vector<PolarAngles> views_, lights_;
  std::vector<uint64_t> first_;  // views + 1
  std::vector<uint32_t> light_of_pair_;
};

// Named sets of directions.

/// "81": bonn_directions(); "105": capture_directions(); any other integer from 1 to kMaxDirections: even_directions(),
/// with directions within 0.11 degrees of the plane raised to that elevation. Throws Error(invalid_argument).
std::vector<PolarAngles> named_directions(const std::string& name);

// Detects directions of a BTF that coincide although their angles differ.

/// Warning about views and lights that coincide with an earlier one (phi 0 and 360, any phi at theta 0); interpolation
/// uses the earlier one only. Nothing if all differ.
std::optional<Warning> repeated_directions(const PairLayout& layout);

// Interpolation between the direction pairs of a BTF, barycentric over views and over lights.

/// For complete layouts. Directions above and below the reference plane are interpolated separately. Immutable.
class PairInterpolation {
 public:
  /// Throws Error(unsupported) for an incomplete layout.
  explicit PairInterpolation(const PairLayout& layout);

  using Corners = DirectionMesh::Weights;
  /// Indices of views (lights) and their weights; empty if the set has no direction on that side of the plane.
  std::optional<Corners> view(const Vec3& wv) const { return views_.at(wv); }
  std::optional<Corners> light(const Vec3& wl) const { return lights_.at(wl); }
  /// Whether views and lights from below are covered.
  bool has_lower_side() const { return view({0, 0, -1}) && light({0, 0, -1}); }
  /// Whether transmission is covered, in either direction.
  bool knows_through() const {
    return (view({0, 0, 1}) && light({0, 0, -1})) || (view({0, 0, -1}) && light({0, 0, 1}));
  }

 private:
  /// A set of directions; those below the plane are mirrored up into a separate mesh.
  struct Sides {
    explicit Sides(const std::vector<PolarAngles>& directions);
    std::optional<Corners> at(const Vec3& direction) const;
    std::array<std::vector<uint32_t>, 2> number;  // index in the set: upper, lower
    std::array<std::optional<DirectionMesh>, 2> mesh;
  };
  Sides views_, lights_;
};

// Held-out pairs of directions, which validate models and are never fitted.

/// `count` pairs; view i is paired with light i only. Directions are sampled uniformly by solid angle up to 75 degrees
/// from the normal, the last ring of measured sets. Deterministic: a smaller set is a prefix of a larger one.
/// `two_sided`: each direction lies above or below the plane with equal probability. Throws Error(invalid_argument)
/// unless `count` is from 1 to kMaxDirections.
PairLayout held_out_pairs(uint32_t count, bool two_sided);

}  // namespace velour
