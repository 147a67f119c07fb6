// A BTF as a sum of products: functions of the direction pair times maps over the texels.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>
#include "btf/measure/btf_measurement.h"
#include "btf/measure/half_floats.h"
#include "btf/measure/pair_layout.h"
#include "image/texels.h"

namespace velour {

/// Transform of f that is represented as a sum.
enum class Companding : uint8_t {
  none = 0,  // f itself
  root = 1,  // the square root of f: weights errors roughly as they are perceived, and f cannot be negative
};

/// Converts a sum to f, and back. Negative sums give f = 0.
inline float expanded(Companding companding, float sum) {
  const float positive = sum > 0 ? sum : 0.0f;
  return companding == Companding::root ? positive * positive : positive;
}
inline float companded(Companding companding, float f) {
  const float positive = f > 0 ? f : 0.0f;
  return companding == Companding::root ? std::sqrt(positive) : f;
}

/// Coefficients of one mip level of the tile.
struct TexelLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> value;  // [row][column][component], row 0 at the bottom
};

/// The sum of color axis a at texel x is
///   s_a = sum over components k of axis a of value_k(x) pair_value_k(wl, wv),
/// with the factors interpolated between pairs and between texels, and f = expanded(axes (s_0, s_1, s_2)). A component
/// may serve a single view: its function then depends on the light alone and is 0 for all other views; interpolation
/// between views is unchanged.
struct FactoredBtf {
  PairLayout layout;  // complete
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};                   // columns: orthonormal directions in RGB
  std::vector<uint8_t> axis;         // [component]: 0, 1, 2, ascending (within each view)
  std::vector<HalfBits> pair_value;  // [pair][component]; [light][component] if components serve one view
  std::vector<TexelLevel> levels;    // finest first; each half the size of the previous one, down to one texel
  std::vector<uint16_t> view = {};   // view served by each component, ascending; empty: all

  size_t components() const { return axis.size(); }
  bool by_view() const { return !view.empty(); }
  /// Number of rows of pair_value.
  uint64_t function_rows() const { return by_view() ? layout.lights().size() : layout.pairs(); }
  /// The row of the first light of a view.
  uint64_t first_row(size_t of_view) const { return by_view() ? 0 : layout.first(of_view); }
  /// Size of all coefficients as stored.
  uint64_t parameter_bytes() const;

  static constexpr size_t kMaxComponents = 512;
  static constexpr size_t kMaxOfView = 160, kMaxOfViews = 16384;  // per view and in total, if components serve one view
};

/// Number of texels in all mip levels together.
uint64_t pyramid_texels(const TexelGrid& grid);

/// Computes f of every texel of the finest level for one pair of directions, [row][column][channel]; zero if the model
/// has no direction on that side of the plane.
class FactoredImages {
 public:
  explicit FactoredImages(const FactoredBtf& btf);
  ~FactoredImages();
  void image(const DirectionPair& pair, std::vector<float>& rgb) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// Component ranges of a factored BTF.

/// Indices of components by the view they serve and by color axis.
class ComponentRanges {
 public:
  struct Range {
    uint32_t begin, end;
    uint32_t count() const { return end - begin; }
  };

  explicit ComponentRanges(const FactoredBtf& btf);

  /// Components of all axes.
  Range of(size_t view) const { return {bounds(view)[0], bounds(view)[3]}; }
  Range of(size_t view, size_t axis) const { return {bounds(view)[axis], bounds(view)[axis + 1]}; }
  /// Number of component groups: one per view, or 1 if all views share all components.
  size_t groups() const { return bounds_.size(); }

 private:
  using Bounds = std::array<uint32_t, 4>;  // first component of each axis, and the end
  const Bounds& bounds(size_t view) const { return bounds_[bounds_.size() == 1 ? 0 : view]; }

  std::vector<Bounds> bounds_;
};

}  // namespace velour
