// A BTF as a sum of products: functions of the direction pair times maps over the texels.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/half_floats.h"
#include "btf/pair_layout.h"
#include "image/half_image.h"

namespace velour {

/// What is summed.
enum class Companding : uint8_t {
  none = 0,  // f itself
  root = 1,  // the square root of f: errors count about as they are seen, and no sum gives a negative f
};

/// f from a sum, and back. Sums below 0 are the roots of nothing.
inline float expanded(Companding companding, float sum) {
  const float positive = sum > 0 ? sum : 0.0f;
  return companding == Companding::root ? positive * positive : positive;
}
inline float companded(Companding companding, float f) {
  const float positive = f > 0 ? f : 0.0f;
  return companding == Companding::root ? std::sqrt(positive) : f;
}

/// The coefficients of one level of the pyramid over the tile.
struct TexelLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> value;  // [row][column][component], row 0 at the bottom
};

/// With a = the colour axis of component k, the sum of axis a at texel x is
///   s_a = sum over k of axis a of value_k(x) pair_value_k(wl, wv),
/// between pairs and between texels by interpolation of the factors, and f = expanded(axes (s_0, s_1, s_2)). A
/// component may serve one view alone: then its function is of the light, it is 0 at all other views, and between views
/// the functions of the pair are interpolated as always.
struct FactoredBtf {
  PairLayout layout;  // complete
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};                   // columns: orthonormal directions in RGB
  std::vector<uint8_t> axis;         // of each component: 0, 1, 2, rising (of each view)
  std::vector<HalfBits> pair_value;  // [pair][component]; [light][component] where components serve a view
  std::vector<TexelLevel> levels;    // the finest first; each half of the one before, down to one texel
  std::vector<uint16_t> view = {};   // that each component serves, rising; empty: all serve all

  size_t components() const { return axis.size(); }
  bool by_view() const { return !view.empty(); }
  /// Rows of pair_value.
  uint64_t function_rows() const { return by_view() ? layout.lights().size() : layout.pairs(); }
  /// The row of the first light of a view.
  uint64_t first_row(size_t of_view) const { return by_view() ? 0 : layout.first(of_view); }
  /// Of all coefficients as they are stored.
  uint64_t parameter_bytes() const;

  static constexpr size_t kMaxComponents = 512;
  static constexpr size_t kMaxOfView = 160, kMaxOfViews = 16384;  // where components serve a view: of one, of all
};

/// How many texels all levels of a pyramid have.
uint64_t pyramid_texels(const TexelGrid& grid);

/// f of every texel of the finest level for one pair of directions, [row][column][channel]; zero where the model has no
/// direction on a side of the plane.
class FactoredImages {
 public:
  explicit FactoredImages(const FactoredBtf& btf);
  ~FactoredImages();
  void image(const DirectionPair& pair, std::vector<float>& rgb) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace velour
