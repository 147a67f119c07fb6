// Interpolation between the direction pairs of a BTF, barycentric over views and over lights.
#pragma once

#include <array>
#include <optional>

#include "btf/measure/pair_layout.h"
#include "math/sphere/direction_mesh.h"

namespace velour {

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

}  // namespace velour
