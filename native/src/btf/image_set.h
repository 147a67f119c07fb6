// A BTF stored as one image file per pair of directions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/load_btf.h"

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

}  // namespace velour
