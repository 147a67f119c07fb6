// A BTF as it was measured or captured.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "brdf/measurement.h"
#include "btf/half_floats.h"
#include "btf/pair_layout.h"
#include "btf/value_counts.h"

namespace velour {

/// Texels of one period of the surface, on the reference plane: z = 0 of local coordinates.
struct TexelGrid {
  uint32_t width = 0, height = 0;                  // along x and y
  std::optional<Vec2> tile_metres = std::nullopt;  // what the grid covers; nothing where it is not known
  uint64_t texels() const { return uint64_t{width} * height; }
  bool operator==(const TexelGrid&) const = default;
};

/// Where the structure is: heights over the lowest point of the shell, in metres (or in widths of the tile where its
/// size is not known).
struct Shell {
  double thickness = 0;         // of the structure, lowest to highest point
  double reference_height = 0;  // of the reference plane
};

/// Per texel, for one view: what a VOTF is made of. Arrays of width x height, row 0 at the bottom.
struct ViewStructure {
  std::vector<float> coverage;       // share of the footprint whose ray meets the structure
  std::vector<float> height_mean;    // of first hits, over the lowest point of the shell; 0 without hits
  std::vector<float> height_spread;  // standard deviation of the same
};

/// The largest number of texels along a side, of directions in a set, and of bytes in all that is read.
inline constexpr uint32_t kMaxTexelsAlong = 16384;
inline constexpr size_t kMaxDirections = 4096;

/// Values: the apparent BRDF of each texel - radiance that leaves its footprint towards wv over the irradiance of the
/// reference plane, E cos(theta_l); 1/sr, linear Rec. 709, without cosine, premultiplied: rays that meet nothing count
/// as 0 (docs/conventions.md). Immutable; calls are thread-safe.
class BtfMeasurement {
 public:
  virtual ~BtfMeasurement() = default;

  /// Images of the pairs [first, first + count), [pair][row][column][channel], row 0 at the bottom (y = 0): `values` of
  /// count x texels x 3. Throws Error(io, bad_data) with a sentence when a file turns out to be damaged.
  virtual void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const = 0;

  /// The same of standard errors of the luminance, count x texels; false where nothing is known of them.
  virtual bool read_errors(uint64_t /*first*/, uint64_t /*count*/, std::span<HalfBits> /*errors*/) const {
    return false;
  }
  /// Nothing where it was not captured.
  virtual std::optional<ViewStructure> read_structure(uint32_t /*view*/) const { return std::nullopt; }

  /// The coverage of the texels alone: of the structure, or the alpha of the view's first picture. Throws as
  /// read_pairs(); nothing where it is not known.
  virtual std::optional<std::vector<float>> read_coverage(uint32_t view) const;

  /// Whether read_errors(), read_structure() and read_coverage() give something.
  virtual bool has_errors() const { return false; }
  virtual bool has_structure() const { return false; }
  virtual bool has_coverage() const { return has_structure(); }

  /// Of all values, where they were counted when the set was made; elsewhere they are counted in a sample of pairs.
  virtual std::optional<ValueCounts> all_counts() const { return std::nullopt; }

  /// Whatever else the source knows, as (key, value) pairs for `info`.
  virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
  /// Sentences for whoever fits or looks at it.
  virtual std::vector<std::string> warnings() const { return {}; }

  const PairLayout& layout() const { return *layout_; }
  const TexelGrid& grid() const { return grid_; }
  const std::optional<Shell>& shell() const { return shell_; }
  const Provenance& provenance() const { return provenance_; }
  /// Bytes of all images as half-float RGB: what ratios of compression are measured against.
  uint64_t raw_bytes() const { return layout().pairs() * grid().texels() * 3 * sizeof(HalfBits); }

 protected:
  /// Throws Error(invalid_argument) unless these pairs are there.
  void check_range(uint64_t first, uint64_t count) const;

  std::optional<PairLayout> layout_;
  TexelGrid grid_;
  std::optional<Shell> shell_;
  Provenance provenance_;  // its sha256 names the content: of the index or of all names and sizes where files are many
};

/// Pairs and what is known of their values: of all of them where they were counted before, else of 16 pairs in four
/// runs, evenly spread (of all where they are no more).
struct CountedPairs {
  uint64_t pairs = 0;
  ValueCounts counts;
};
CountedPairs count_values(const BtfMeasurement& btf);

}  // namespace velour
