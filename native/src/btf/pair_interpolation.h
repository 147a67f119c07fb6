// Between the direction pairs of a BTF: barycentric over views and over lights.
#pragma once

#include <array>
#include <optional>

#include "btf/pair_layout.h"
#include "sphere/direction_mesh.h"

namespace velour {

/// For complete layouts. Directions above the reference plane and below it are interpolated apart; a side that has no
/// direction of its own answers with nothing. Immutable.
class PairInterpolation {
 public:
  /// Throws Error(unsupported) for a layout that is not complete.
  explicit PairInterpolation(const PairLayout& layout);

  using Corners = DirectionMesh::Weights;
  /// Numbers of views (lights) and their weights; nothing where the set has no direction on that side of the plane.
  std::optional<Corners> view(const Vec3& wv) const { return views_.at(wv); }
  std::optional<Corners> light(const Vec3& wl) const { return lights_.at(wl); }
  /// Whether it knows what is seen, and lit, from below.
  bool has_lower_side() const { return view({0, 0, -1}) && light({0, 0, -1}); }
  /// Whether it knows light that comes through to either side.
  bool knows_through() const {
    return (view({0, 0, 1}) && light({0, 0, -1})) || (view({0, 0, -1}) && light({0, 0, 1}));
  }

 private:
  /// A set of directions, the lower ones mirrored up into a mesh of their own.
  struct Sides {
    explicit Sides(const std::vector<PolarAngles>& directions);
    std::optional<Corners> at(const Vec3& direction) const;
    std::array<std::vector<uint32_t>, 2> number;  // of the set: upper, lower
    std::array<std::optional<DirectionMesh>, 2> mesh;
  };
  Sides views_, lights_;
};

}  // namespace velour
