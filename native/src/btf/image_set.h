// A BTF measured as pictures: one file a pair of directions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/load_btf.h"

namespace velour {

/// A picture and the pair of directions it was taken at. `view_number` and `light_number` say where in their sets the
/// directions come; directions come in the order of their smallest number.
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

/// Checks that all pictures are there and of one size; their pixels are read when asked for. Throws Error(io, bad_data)
/// that names the picture at fault.
std::shared_ptr<const BtfMeasurement> load_image_set(ImageSetSource source, const BtfLoadOptions& options);

}  // namespace velour
