// BRDF measurements, where they came from, and which of their entries are valid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "base/progress.h"
#include "math/sphere/vec.h"

namespace velour {

/// Where the data came from.
struct Provenance {
  std::string path;         // as given by the caller
  std::string name;         // file name without folder and extension
  std::string format;       // "merl", "rgl", "cornell", "window-bsdf", "velour-table"
  std::string description;  // what the file says of itself; may be empty
  std::string sha256;       // of the file's bytes, lower-case hex
  uint64_t file_bytes = 0;
};

/// Numbers of entries by validity; `total = valid + invalid() + below_horizon`.
struct EntryCounts {
  uint64_t total = 0;
  uint64_t valid = 0;
  uint64_t negative = 0;       // MERL: any channel negative; elsewhere: negative luminance
  uint64_t not_finite = 0;     // NaN or infinite
  uint64_t below_horizon = 0;  // directions that cannot be measured
  uint64_t spikes = 0;         // irregular samples left out (without_spikes)
  uint64_t out_of_gamut = 0;   // of the valid ones: a negative channel with positive luminance; kept as it is
  uint64_t invalid() const { return negative + not_finite; }
};

/// One irregular sample. Such samples are fitted directly, without interpolation.
struct IrregularSample {
  Vec3 wl, wv;
  Rgb f;
};

/// A BRDF measurement. Immutable after loading; every call is thread-safe.
///
/// `eval` is the measurement's own documented interpolation (docs/reference/measurement_formats.md). A direction pair
/// with no valid entry in reach is not covered: its `valid` is 0 and its f is 0. Nothing is extrapolated. f is in 1/sr,
/// linear Rec. 709, without cosine; a channel may be negative (a color outside Rec. 709).
class Measurement {
 public:
  virtual ~Measurement() = default;

  /// f of each wl for one view. `valid[i]` is 1 where the measurement covers the pair. Directions at or below the
  /// horizon give 0, not covered.
  virtual void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const = 0;

  /// True when f depends on the azimuth difference alone.
  virtual bool isotropic() const = 0;

  /// Whether the view at `theta_v` (radians; any azimuth) was measured. If not, errors there are reported as null.
  virtual bool covers_view(float theta_v) const = 0;

  /// The irregular samples; empty for tables.
  virtual std::span<const IrregularSample> samples() const { return {}; }

  /// For irregular samples: the same measurement without the samples i with held_out_sample(i)
  /// (brdf/measure/held_out.h), so that its interpolation does not depend on them. Tables return nullptr: a fit leaves
  /// out their views and lights.
  virtual std::shared_ptr<const Measurement> without_held_out(const Progress& /*progress*/) const { return nullptr; }

  /// Sizes, units, scales and whatever else the format knows, as (key, value) pairs for `info`.
  virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }

  const Provenance& provenance() const { return provenance_; }
  const EntryCounts& counts() const { return counts_; }

 protected:
  Provenance provenance_;
  EntryCounts counts_;
};

/// Reads any supported file; the format is recognized from the content. Throws Error(io, bad_data, unsupported) with a
/// message that names file, field and value, Error(cancelled) once `progress` is canceled. Never allocates more than
/// the file's size justifies.
std::shared_ptr<const Measurement> load_measurement(const std::string& path, const Progress& progress = Progress());

/// True when the first bytes of `path` look like one of the measurement formats.
bool is_measurement_file(const std::string& path);

// Validity of the entries of a measurement.

/// When a finite entry counts as negative: MERL marks invalid entries by a negative value in any channel. Elsewhere a
/// channel may be negative because the color is outside Rec. 709, and only a negative luminance is invalid.
enum class NegativeRule { any_channel, luminance };

/// Values beyond this count as not finite: sums over them would overflow.
inline constexpr float kLargestEntry = 1e30f;

/// Counts an entry above the horizon and returns whether it is valid.
inline bool count_entry(const Rgb& f, NegativeRule rule, EntryCounts& counts) {
  ++counts.total;
  const bool finite = std::abs(f.r) < kLargestEntry && std::abs(f.g) < kLargestEntry && std::abs(f.b) < kLargestEntry;
  if (!finite) return ++counts.not_finite, false;
  const bool negative_channel = std::min({f.r, f.g, f.b}) < 0.0f;
  if (rule == NegativeRule::any_channel ? negative_channel : luminance(f) < 0.0f) return ++counts.negative, false;
  ++counts.valid;
  if (negative_channel) ++counts.out_of_gamut;
  return true;
}

inline void count_below_horizon(EntryCounts& counts) {
  ++counts.total;
  ++counts.below_horizon;
}

}  // namespace velour
