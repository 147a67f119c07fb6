// A measured or captured BTF.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "base/warning.h"
#include "brdf/measure/measurement.h"
#include "btf/measure/half_floats.h"
#include "btf/measure/pair_layout.h"

namespace velour {

// Counts of invalid values in a BTF, for reports; the data is left as it is.

struct ValueCounts {
  uint64_t values = 0;      // channels of the texels examined
  uint64_t not_finite = 0;  // NaN or infinite; excluded from fits
  uint64_t negative = 0;    // below 0: colors outside Rec. 709 or camera noise; kept

  void add(std::span<const HalfBits> halves);
  ValueCounts& operator+=(const ValueCounts& other);
  bool operator==(const ValueCounts&) const = default;
};

/// Texels of one period of the surface on the reference plane, z = 0 in local coordinates.
struct TexelGrid {
  uint32_t width = 0, height = 0;                  // along x and y
  std::optional<Vec2> tile_metres = std::nullopt;  // extent of the grid in meters, if known
  uint64_t texels() const { return uint64_t{width} * height; }
  bool operator==(const TexelGrid&) const = default;
};

/// Height range of the structure over the lowest point of the shell, in meters (tile widths if the tile size is
/// unknown).
struct Shell {
  double thickness = 0;         // from the lowest to the highest point of the structure
  double reference_height = 0;  // height of the reference plane
};

/// Per-texel input to a VOTF, for one view. Arrays of width x height, row 0 at the bottom.
struct ViewStructure {
  std::vector<float> coverage;       // fraction of the footprint's rays that hit the structure
  std::vector<float> height_mean;    // mean height of first hits over the lowest point of the shell; 0 without hits
  std::vector<float> height_spread;  // standard deviation of the heights of first hits
};

/// Maximum number of texels along a side, and of directions in a set.
inline constexpr uint32_t kMaxTexelsAlong = 16384;
inline constexpr size_t kMaxDirections = 4096;

/// Values are the apparent BRDF of each texel: the radiance leaving its footprint towards wv, divided by the irradiance
/// of the reference plane, E cos(theta_l). In 1/sr, linear Rec. 709, without the cosine, premultiplied: rays that hit
/// nothing count as 0 (docs/engine/conventions.md). Immutable; calls are thread-safe.
class BtfMeasurement {
 public:
  virtual ~BtfMeasurement() = default;

  /// Reads the images of pairs [first, first + count) as [pair][row][column][channel], row 0 at the bottom (y = 0).
  /// `values` has count x texels x 3 elements. Throws Error(io, bad_data) with one sentence if a file is damaged.
  virtual void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const = 0;

  /// Reads the standard errors of the luminance, count x texels. Returns false if they are unknown.
  virtual bool read_errors(uint64_t /*first*/, uint64_t /*count*/, std::span<HalfBits> /*errors*/) const {
    return false;
  }
  /// Empty if the structure was not captured.
  virtual std::optional<ViewStructure> read_structure(uint32_t /*view*/) const { return std::nullopt; }

  /// Reads the coverage of the texels alone: that of the structure, or the alpha of the view's first image. Throws like
  /// read_pairs(). Empty if the coverage is unknown.
  virtual std::optional<std::vector<float>> read_coverage(uint32_t view) const;

  /// Whether read_errors(), read_structure() and read_coverage() return data.
  virtual bool has_errors() const { return false; }
  virtual bool has_structure() const { return false; }
  virtual bool has_coverage() const { return has_structure(); }

  /// Counts over all values, if they were taken when the set was made; otherwise count_values() samples pairs.
  virtual std::optional<ValueCounts> all_counts() const { return std::nullopt; }

  /// Further facts about the source, as (key, value) pairs for `info`.
  virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
  /// Warnings for users of the data.
  virtual std::vector<Warning> warnings() const { return {}; }

  const PairLayout& layout() const { return *layout_; }
  const TexelGrid& grid() const { return grid_; }
  const std::optional<Shell>& shell() const { return shell_; }
  const Provenance& provenance() const { return provenance_; }
  /// Size in bytes of all images as half-float RGB, the reference for compression ratios.
  uint64_t raw_bytes() const { return layout().pairs() * grid().texels() * 3 * sizeof(HalfBits); }

 protected:
  /// Throws Error(invalid_argument) unless these pairs exist.
  void check_range(uint64_t first, uint64_t count) const;

  std::optional<PairLayout> layout_;
  TexelGrid grid_;
  std::optional<Shell> shell_;
  Provenance provenance_;  // its sha256 is that of the file or index, or of all names and sizes if there are many files
};

/// Value counts and the number of pairs they cover: all pairs if BtfMeasurement::all_counts() has them or there are at
/// most 16, otherwise 16 pairs in four evenly spaced runs.
struct CountedPairs {
  uint64_t pairs = 0;
  ValueCounts counts;
};
CountedPairs count_values(const BtfMeasurement& btf);

// Replacement of non-finite values in images.

/// Replaces non-finite values of `image` ([texel][channel], three channels) by the mean of the finite ones, per
/// channel, so that they do not bias a fit. Returns their number.
uint64_t mend_image(std::span<float> image);

}  // namespace velour
