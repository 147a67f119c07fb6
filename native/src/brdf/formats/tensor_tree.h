// Functions over the unit cube of three or four dimensions as a tree of cells: the variable-resolution BSDFs of
// Radiance [WKB12].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

/// A node halves every side of its cube (2^n branches; bit i of a branch's index selects the half of dimension i), or
/// is a grid of 2^k cells per side (the last dimension varies fastest). Constant within a cell.
class TensorTree {
 public:
  /// Reads "{ {1 2 3 ...} {...} ... }": a node is its branches or its grid's numbers in braces, separated by commas or
  /// white space. Numbers beyond a float's range become infinity or 0. Throws Error(bad_data) that begins with `where`.
  TensorTree(std::string_view text, int dimensions, const std::string& where);

  /// Value at a point of [0, 1]^n; 1 belongs to the last cell.
  float at(std::span<const float> place) const;

  int dimensions() const { return dimensions_; }
  /// The values of all cells, in the order of the file.
  std::span<const float> values() const { return values_; }
  /// The smallest cells are 2^-this wide.
  int finest_level() const { return finest_level_; }

 private:
  class Reader;
  struct Grid {
    uint32_t first;  // in `values_`
    int32_t level;   // 2^level cells per side
  };
  // A node >= 0 is the index of its first branch in `branches_`; a node < 0 is the grid ~node.
  int32_t root_ = 0;
  int dimensions_;
  int finest_level_ = 0;
  std::vector<int32_t> branches_;
  std::vector<Grid> grids_;
  std::vector<float> values_;
};

/// Shirley and Chiu's equal-area map [SC97] of the unit disk to the unit square.
Vec2 square_of_disk(const Vec2& disk);

}  // namespace velour
