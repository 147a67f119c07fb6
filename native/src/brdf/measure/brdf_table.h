// Velour's own table of an anisotropic BRDF ("velour-table"), written by a virtual goniometer where MERL's layout would
// lose the azimuth. An OpenEXR file of named tensors; docs/reference/measurement_formats.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "brdf/measure/half_diff.h"
#include "brdf/measure/measurement.h"

namespace velour {

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

}  // namespace velour
