// Densities on the unit square, bilinear between the nodes of a grid, and the warp that each defines [RGL].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

/// Up to four slices of a table and their weights, which sum to one: bilinear interpolation in the view.
struct SliceMix {
  std::array<uint32_t, 4> slice{};
  std::array<float, 4> weight{};
  int count = 0;

  void add(uint32_t s, float w) {
    if (w == 0.0f) return;
    slice[static_cast<size_t>(count)] = s;
    weight[static_cast<size_t>(count++)] = w;
  }
};

/// Cell of a position in [0, 1] on an axis of `count` >= 2 nodes.
struct AxisCell {
  uint32_t low;
  float t;
};
inline AxisCell axis_cell(float position, uint32_t count) {
  const float scaled = position * static_cast<float>(count - 1);
  const uint32_t low = std::min(static_cast<uint32_t>(scaled), count - 2);
  return {low, scaled - static_cast<float>(low)};
}

class BilinearWarp {
 public:
  /// `values` holds slices x height x width non-negative node values; each slice is scaled to unit integral. Width and
  /// height are at least 2.
  BilinearWarp(std::span<const float> values, uint32_t width, uint32_t height);

  /// u with warp(u) = `position` in the mixture of slices: u.y from the marginal of y, u.x from the density of x given
  /// y. False if the density vanishes along the whole row, so that u.x is undefined.
  bool invert(const SliceMix& mix, const Vec2& position, Vec2& u) const;

  /// Maps uniform u to a position with the density of the mixture.
  Vec2 warp(const SliceMix& mix, const Vec2& u) const;

 private:
  struct Node {
    float density;  // scaled so that the slice's trapezoid sum over cells is one
    float running;  // integral along the row from its first node, in units of a cell
  };
  const Node& node(uint32_t slice, uint32_t y, uint32_t x) const {
    return nodes_[(static_cast<size_t>(slice) * height_ + y) * width_ + x];
  }
  float row_sum(const SliceMix& mix, uint32_t y) const;
  float rows_below(const SliceMix& mix, uint32_t y) const;
  void build_slice(std::span<const float> values, uint32_t slice);

  uint32_t width_, height_;
  std::vector<Node> nodes_;
  std::vector<float> rows_below_;  // slices x height: integral of the rows up to y, in units of a row
};

}  // namespace velour
