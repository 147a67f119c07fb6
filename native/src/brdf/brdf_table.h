// Velour's own table of an anisotropic BRDF ("velour-table"), written by a virtual goniometer where MERL's layout would
// lose the azimuth. An OpenEXR file of named tensors; docs/reference/measurement_formats.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "brdf/measurement.h"

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

}  // namespace velour
