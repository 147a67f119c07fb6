// A BTF stored as one image file per pair of directions.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>
#include "btf/formats/load_btf.h"
#include "btf/measure/btf_measurement.h"
#include "math/sphere/vec.h"

namespace velour {

/// An image and its pair of directions. `view_number` and `light_number` determine the order of the directions in their
/// sets; a direction is placed by its smallest number.
struct PairPicture {
  std::string path;
  PolarAngles view, light;
  uint64_t view_number = 0, light_number = 0;
};

struct ImageSetSource {
  std::string path;    // as given by the caller
  std::string format;  // "ubo2003", "csv"
  std::vector<PairPicture> pictures;
};

/// Checks that all images exist and have the same size; pixels are read on demand. Throws Error(io, bad_data) that
/// names the image at fault.
std::shared_ptr<const BtfMeasurement> load_image_set(ImageSetSource source, const BtfLoadOptions& options);

// Validation of a BTF's tile size.

/// Whether both extents, in meters along x and y, are positive and finite.
inline bool is_tile_size(const Vec2& metres) {
  return metres.x > 0 && metres.y > 0 && std::isfinite(metres.x) && std::isfinite(metres.y);
}

// Conversion of source values to the apparent BRDF. Internal to btf/.

/// f = number * factor, divided by |cos(theta_l)| if the number includes that cosine.
struct ValueScale {
  double factor = 1;
  bool cosine = false;

  float of(const PolarAngles& light) const;
  /// For `info`: "f = number / (pi cos(theta_l))".
  std::string text() const;
};

/// `values` must not be `automatic`.
ValueScale scale_of(BtfValues values);

}  // namespace velour
