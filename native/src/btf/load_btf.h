// Reads BTFs of every kind.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "btf/btf_measurement.h"
#include "image/picture.h"

namespace velour {

/// What a number in a picture, or in a .btf file, means. White is a surface that reflects all light evenly.
enum class BtfValues {
  automatic,    // as the pictures say of themselves (Velour's exports do); other pictures: radiance; .btf files: brdf
  brdf,         // the apparent BRDF in 1/sr
  reflectance,  // pi times that: white is 1
  radiance,     // pi cos(theta_l) times it: white is the cosine of the light, as a camera sees it under a distant lamp
};

/// The unit of angles in a CSV index. Automatic: degrees, and refused where they look like radians.
enum class BtfAngles { automatic, degrees, radians };

/// What the three channels of pictures are.
enum class BtfColors { rec709, xyz };

struct BtfLoadOptions {
  BtfValues values = BtfValues::automatic;
  BtfColors colors = BtfColors::rec709;
  TransferCurve curve;  // of pictures of whole numbers
  BtfAngles angles = BtfAngles::automatic;
  std::string layer = {};                          // of OpenEXR pictures (PictureOptions)
  std::optional<Vec2> tile_metres = std::nullopt;  // in place of what the source says, if it says anything
};

/// By what `path` is: a folder of Velour's own or its btf.json; a folder of pictures that are named for their angles; a
/// CSV index of pictures, or a folder that holds one as btf.csv; a .btf file of Bonn (docs/btf.md). Throws Error(io,
/// bad_data, unsupported) with one sentence that names file and remedy.
std::shared_ptr<const BtfMeasurement> load_btf(const std::string& path, const BtfLoadOptions& options = {});

/// Whether `path` looks like one of these: a folder, a CSV index, a .btf file.
bool is_btf(const std::string& path);

}  // namespace velour
