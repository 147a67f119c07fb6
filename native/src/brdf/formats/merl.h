// The MERL table: isotropic, 90 x 90 x 180 nodes over half and difference angles [MERL].
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "brdf/measure/measurement.h"

namespace velour {

/// Node (i, j, k): theta_h = i^2 / 90 degrees, theta_d = j degrees, phi_d = k degrees [R98], so that both the mirror
/// peak and grazing angles have nodes. k has period 180 by reciprocity.
struct MerlGrid {
  static constexpr int theta_h = 90, theta_d = 90, phi_d = 180;
  static constexpr size_t size = size_t{90} * 90 * 180;
  static size_t index(int i, int j, int k) {
    return (static_cast<size_t>(i) * theta_d + static_cast<size_t>(j)) * phi_d + static_cast<size_t>(k);
  }
  /// The node's directions with the half vector in the plane phi = 0; either may lie below the horizon (z <= 0), where
  /// no measurement exists.
  static DirectionPair pair(int i, int j, int k);
};

/// Writes a `.binary` file of 34,992,012 bytes. `planes`: 3 x MerlGrid::size values of f in 1/sr, linear Rec. 709,
/// without cosine: all of red, then green, then blue. A node where any channel is negative or not finite, or a
/// direction below the horizon, is stored as -1, the format's mark of an invalid entry. Atomic.
void write_merl(const std::string& path, std::span<const double> planes);

/// True for bytes that begin with three plausible node counts, as a MERL file does.
bool looks_like_merl(std::span<const uint8_t> head);

/// Accepts any node counts (node (i, j, k) of n x m x l: theta_h = 90 (i/n)^2, theta_d = 90 j/m, phi_d = 180 k/l
/// degrees), float64 or float32, either byte order; the file's length must match its header. Throws Error(bad_data).
/// `provenance` has path, name, sha256 and size already.
std::shared_ptr<const Measurement> read_merl(std::span<const uint8_t> bytes, Provenance provenance);

}  // namespace velour
