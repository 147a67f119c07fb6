// Light directions of one view, as dense as what the view reflects.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "brdf/measure/measurement.h"
#include "math/sphere/vec.h"

namespace velour {

/// Directions above the horizon and the solid angles (sr) that they represent.
struct WeightedLights {
  std::vector<Vec3> wl;
  std::vector<double> weight;
};

/// Measured f (1/sr, no cosine) at one light direction.
struct LightValue {
  Rgb f{0};
  float spread = 0;  // variance of the luminances that f is the mean of
  bool valid = false;
};

/// Reads the values at `wl`; `values` has as many entries, not valid on entry.
using LightReader = std::function<void(std::span<const Vec3> wl, std::span<LightValue> values)>;
/// Reads a measurement, which must outlive the result, at the view `wv`. Values that are not finite are not valid.
LightReader reader_of(const Measurement& measurement, const Vec3& wv);

/// A quadtree over the light directions of one view. Lambert's equal-area map takes the hemisphere to a disk, and the
/// concentric map [SC97] takes the disk to a square, so a cell's solid angle is exact: (pi / 2) side^2. Cells are split
/// until none holds more than 1 / parts of what the view reflects, the mean of its shares of the integrals of
/// (f cos)^2 and of f cos. A highlight is sampled by hundreds of directions at every view, however narrow. To find it,
/// cells are first split towards the mirror direction and towards the view, where measured materials are sharp; such
/// cells are joined again where f cos hardly varies between them.
class DirectionTree {
 public:
  /// A part of the square and one direction in it, at a place that a hash of the cell chooses: in a regular pattern, an
  /// elongated lobe could hide between the rows.
  struct Cell {
    Vec2 corner;
    float side;
    int32_t first_child = -1;  // of four; -1: a leaf
    Vec3 wl{0, 0, 1};
    LightValue value = {};
    bool read = false;

    bool leaf() const { return first_child < 0; }
    double solid_angle() const { return 0.5 * kPiD * static_cast<double>(side) * static_cast<double>(side); }  // sr
    double luminance_cos() const {
      return value.valid ? static_cast<double>(luminance(value.f)) * static_cast<double>(wl.z) : 0.0;
    }
  };

  /// `folded`: covers only lights with wl.y >= 0, for views on the meridian whose values are symmetric about it.
  DirectionTree(const LightReader& read, const Vec3& wv, int parts, bool folded = false);

  /// Indices of the leaves, neighbors close to each other.
  std::span<const uint32_t> leaves() const { return leaves_; }
  const Cell& cell(uint32_t index) const { return cells_[index]; }
  /// The leaf that contains `wl`; its image at wl.y >= 0 if folded.
  const Cell& leaf_at(const Vec3& wl) const;

  /// `count` directions, stratified over the leaves by what they reflect. Sets of different seeds are independent.
  /// Their mean density per solid angle is count x density(). Not for folded trees.
  void sample(size_t count, uint64_t seed, std::vector<Vec3>& out) const;
  /// Probability density (1/sr) of a direction of sample(): 0.4 by (f cos)^2, 0.4 by f cos, 0.2 uniform; f cos is at
  /// least a quarter of that of neighboring leaves. Not for folded trees.
  double density(const Vec3& wl) const;

 private:
  /// Integrals over the leaves.
  struct Sums {
    double energy = 0, light = 0;  // of (f cos)^2 and of f cos, both of the luminance
    double share(const Cell& cell) const;
  };

  void plant();
  void split(uint32_t index);
  void split_about(const Vec3& axis, float finest);
  void read_new(const LightReader& read);
  Sums sums() const;
  bool split_bright(const LightReader& read, int parts);
  void split_neighbors(uint32_t index);
  bool join(uint32_t index, const Sums& sums, int parts);
  void list_leaves(uint32_t index);
  double brightness(uint32_t leaf) const;
  void list_densities();
  uint32_t leaf_of(Vec2 place) const;

  bool folded_;
  size_t roots_ = 0;
  std::vector<Cell> cells_;
  std::vector<uint32_t> leaves_;
  std::vector<double> running_;      // sums of the leaves' probabilities
  std::vector<float> leaf_density_;  // 1/sr, of each cell; 0: not a leaf
};

}  // namespace velour
