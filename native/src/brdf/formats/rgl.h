// The adaptive parameterization of the RGL material database [RGL].
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"
#include "math/sphere/vec.h"

namespace velour {

// Densities on the unit square, bilinear between the nodes of a grid, and the warp that each defines [RGL].

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

// Half vectors in the units of RGL tables, for several light directions at once.

/// A view, mirrored into the measured sector, and the same map for light directions.
struct RglView {
  Vec3 wv;
  Vec2 flip{1, 1};                 // signs for x and y of the light
  float cos_phi = 1, sin_phi = 0;  // reference azimuth of half vectors
};

/// For each of up to 16 `wl` the (theta, phi) of its half vector in the paper's units: sqrt(2 theta / pi) and (phi +
/// pi) / 2 pi in [0, 1). Absolute error 1e-6. SIMD, dispatched at run time.
inline constexpr size_t kRglPositions = 16;
void half_vector_positions(const RglView& view, std::span<const Vec3> wl, Vec2* positions);

/// True for bytes that begin like the tensor container of .bsdf files.
bool looks_like_rgl(std::span<const uint8_t> head);

/// `provenance` has path, name, sha256 and size already. Colors come from "rgb", else from "spectra" and "wavelengths".
std::shared_ptr<const Measurement> read_rgl(std::span<const uint8_t> bytes, Provenance provenance);

// The run-time look-up of an RGL measurement.

/// Node values over (theta, phi) in the paper's units; width is the axis of theta.
struct AngleGrid {
  uint32_t width = 0, height = 0;
  std::vector<float> values;

  /// Bilinear at `u` in the unit square.
  float at(const Vec2& u) const;
};

/// Contents of the file, checked.
struct RglTables {
  std::vector<float> phi_v, theta_v;  // radians, increasing: the views; one phi (or two): isotropic
  AngleGrid normals, projected_area;  // D(theta_m, phi_m) and sigma(theta_v, phi_v)
  uint32_t warp_width = 0, warp_height = 0;
  std::vector<float> visible_normals;  // views x height x width
  uint32_t width = 0, height = 0;      // of the color slices
  std::vector<Rgb> color;              // views x height x width
  bool microfacet_scale = true;        // the file's "jacobian": multiply colors by D / (4 sigma)
};

class RglMeasurement : public Measurement {
 public:
  RglMeasurement(RglTables tables, Provenance provenance);

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override;
  bool isotropic() const override { return tables_.phi_v.size() <= 2; }
  bool covers_view(float theta_v) const override { return coverage_.covers(theta_v); }
  std::vector<std::pair<std::string, std::string>> details() const override;

 private:
  /// View-dependent state.
  struct View {
    RglView frame;
    SliceMix mix;
    float scale = 1;  // 1 / (4 sigma)
    bool covered = false;
  };
  View prepare(const Vec3& wv) const;
  SliceMix mix_of(float phi, float theta) const;
  bool lookup(const View& view, const Vec2& position, const Vec2& u, float cosine, Rgb& f) const;
  void build_nodes();
  bool texel_above_horizon(uint32_t slice, uint32_t y, uint32_t x) const;

  RglTables tables_;
  BilinearWarp warp_;
  std::vector<TableNode> nodes_;
  int sectors_ = 1;  // the views span 2 pi / sectors; the rest follows by symmetry
  ViewCoverage coverage_;
};

}  // namespace velour
