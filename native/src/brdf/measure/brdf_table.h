// Tables of BRDFs: Velour's own, and measurements that are tables over half and difference angles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "brdf/measure/measurement.h"
#include "math/sphere/vec.h"

namespace velour {

// Half and difference angles of a direction pair [R98].

// atan2 for table look-ups: measurements are evaluated millions of times, and libm's takes most of that time.

/// atan2(y, x) in radians, absolute error below 3e-7; 0 at the origin. Abramowitz & Stegun 4.4.49 on [0, 1].
inline float fast_atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay);
  const float t = larger > 0.0f ? std::min(ax, ay) / larger : 0.0f;
  const float s = t * t;
  float p = 0.0028662257f;
  p = p * s - 0.0161657367f;
  p = p * s + 0.0429096138f;
  p = p * s - 0.0752896400f;
  p = p * s + 0.1065626393f;
  p = p * s - 0.1420889944f;
  p = p * s + 0.1999355085f;
  p = p * s - 0.3333314528f;
  float angle = t + t * s * p;
  if (ay > ax) angle = 1.57079632679f - angle;
  if (x < 0.0f) angle = 3.14159265359f - angle;
  return std::copysign(angle, y);
}

/// Radians. theta_h, theta_d in [0, pi/2]; phi_h in (-pi, pi]; phi_d in [0, pi], because exchanging wl and wv adds pi
/// to it and the tables that use it are reciprocal.
struct HalfDiff {
  float theta_h, phi_h, theta_d, phi_d;
};

/// Both directions above the horizon. Defined everywhere there: with the half vector on the normal phi_h is 0, with wl
/// = wv phi_d is 0. No arc cosine: angles come from lengths, so small ones keep their digits.
inline HalfDiff half_diff(const Vec3& wl, const Vec3& wv) {
  const Vec3 sum = wl + wv, diff = wl - wv;
  const float sum_xy_sq = sum.x * sum.x + sum.y * sum.y;
  const float sum_xy = std::sqrt(sum_xy_sq), sum_length = std::sqrt(sum_xy_sq + sum.z * sum.z);
  // diff along the tangents of growing theta_h and phi_h, both times |sum_xy| |sum|.
  const bool on_normal = sum_xy_sq == 0.0f;
  const float across = on_normal ? diff.y : (diff.y * sum.x - diff.x * sum.y) * sum_length;
  const float along = on_normal ? diff.x : (diff.x * sum.x + diff.y * sum.y) * sum.z - sum_xy_sq * diff.z;
  const float phi_d = fast_atan2(across, along);
  return {fast_atan2(sum_xy, sum.z), fast_atan2(sum.y, sum.x), fast_atan2(glm::length(diff), sum_length),
          phi_d < 0.0f ? phi_d + kPi : phi_d};
}

/// The pair of directions with given angles (radians); either direction may lie below the horizon.
DirectionPair pair_of_half_diff(double theta_h, double phi_h, double theta_d, double phi_d);

// Velour's own table of an anisotropic BRDF ("velour-table"), written by a virtual goniometer where MERL's layout would
// lose the azimuth. An OpenEXR file of named tensors; docs/reference/measurement_formats.md.

/// Nodes over half and difference angles [R98], all in radians:
///   theta_h(i) = pi/2 (i / theta_h)^theta_h_power   dense about the mirror direction, where highlights are sharp
///   phi_h(j)   = 2 pi / folds * j / phi_h           period 2 pi / folds
///   theta_d(k) = pi/2 k / theta_d
///   phi_d(l)   = pi l / phi_d                       period pi by reciprocity
/// The half vector keeps its azimuth, so a stretched highlight lies along the axes of the table and not across them.
struct BrdfTableLayout {
  int theta_h = 64, phi_h = 36, theta_d = 24, phi_d = 24;
  /// 1: any surface. 2: the surface looks the same after half a turn about its normal (every height field with a
  /// symmetric correlation), so half the azimuths suffice.
  int folds = 1;
  double theta_h_power = 2;

  size_t size() const { return index(theta_h, 0, 0, 0); }
  size_t index(int i, int j, int k, int l) const {
    const auto at = [](int a) { return static_cast<size_t>(a); };
    return ((at(i) * at(phi_h) + at(j)) * at(theta_d) + at(k)) * at(phi_d) + at(l);
  }
  /// The node's directions; either may lie below the horizon (z <= 0), where no measurement exists.
  DirectionPair pair(int i, int j, int k, int l) const;
};

/// Input of the writer: `f[layout.index(i, j, k, l)]` in 1/sr, linear Rec. 709, without cosine; NaN in any channel
/// where nothing was measured. Nodes below the horizon are ignored.
struct BrdfTable {
  BrdfTableLayout layout;
  std::vector<Rgb> f;
  std::string description;  // free text for `info`: how it was made
};

/// Writes atomically. Throws Error(invalid_argument) if sizes disagree.
void write_brdf_table(const std::string& path, const BrdfTable& table);

/// `provenance` has path, name, sha256 and size already. Reads an OpenEXR file whose "velour.kind" is "brdf_table".
std::shared_ptr<const Measurement> read_brdf_table(std::span<const uint8_t> bytes, Provenance provenance);

// A dense table over half and difference angles: MERL's, Velour's own, and resampled irregular samples.

/// r, g, b and 1 for a valid node; four zeros for an invalid one, so that one weighted sum gives both the value and the
/// weight of the valid nodes.
struct alignas(16) TableNode {
  float value[4] = {0, 0, 0, 0};
};

class HalfDiffTable {
 public:
  /// `nodes` are indexed by layout.index(). A MERL table is the layout {90, 1, 90, 180}.
  HalfDiffTable(const BrdfTableLayout& layout, std::vector<TableNode> nodes);

  /// Multilinear in the table's own coordinates over the valid corners, whose weights are scaled to sum to one;
  /// periodic in the azimuths, clamped past the last node. False, and f = 0, if no corner is valid. Both directions
  /// must be above the horizon.
  bool lookup(const Vec3& wl, const Vec3& wv, Rgb& f) const;

  const BrdfTableLayout& layout() const { return layout_; }

 private:
  /// Two neighboring nodes on an axis and the weight of the second.
  struct Step {
    size_t low, high;
    float weight;
  };
  static Step clamped(float position, int count);
  static Step periodic(float position, int count);
  Step theta_h_step(float theta_h) const;
  void add_plane(size_t base, const Step& theta_d, const Step& phi_d, float weight, float sum[4]) const;

  BrdfTableLayout layout_;
  std::vector<TableNode> nodes_;
};

/// Which nodes of a layout have both directions above the horizon.
class HorizonTest {
 public:
  explicit HorizonTest(const BrdfTableLayout& layout);
  bool above(int i, int k, int l) const {
    const double upright = cos_h_[size(i)] * cos_d_[size(k)];
    return upright > std::abs(sin_h_[size(i)] * sin_d_[size(k)] * cos_phi_[size(l)]);
  }

 private:
  static size_t size(int a) { return static_cast<size_t>(a); }
  std::vector<double> sin_h_, cos_h_, sin_d_, cos_d_, cos_phi_;
};

// A measurement that is a table over half and difference angles.

// View angles that a measurement covers.

class ViewCoverage {
 public:
  ViewCoverage() = default;
  /// Evaluates `measurement` at every integer degree (0..89, azimuth 0) for a few hundred equal-area light directions;
  /// a view is covered if at least half of them are.
  explicit ViewCoverage(const Measurement& measurement);

  /// `theta_v` in radians; the nearest whole degree decides. False at and below the horizon.
  bool covers(float theta_v) const;

 private:
  std::array<bool, 90> covered_{};
};

class TableMeasurement : public Measurement {
 public:
  using Details = std::vector<std::pair<std::string, std::string>>;

  TableMeasurement(HalfDiffTable table, Provenance provenance, const EntryCounts& counts, Details details);

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override;
  bool isotropic() const override { return table_.layout().phi_h == 1; }
  bool covers_view(float theta_v) const override { return coverage_.covers(theta_v); }
  Details details() const override { return details_; }

 private:
  HalfDiffTable table_;
  Details details_;
  ViewCoverage coverage_;
};

}  // namespace velour
