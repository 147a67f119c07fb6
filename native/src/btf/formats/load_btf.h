// Loads BTFs of all supported formats.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "btf/measure/btf_measurement.h"
#include "image/picture.h"

namespace velour {

/// Meaning of the numbers in an image or .btf file. White is a perfectly diffuse surface that reflects all light.
enum class BtfValues {
  automatic,    // as tagged (Velour's exports are); untagged images: radiance; .btf files: brdf
  brdf,         // the apparent BRDF in 1/sr
  reflectance,  // pi times the BRDF: white is 1
  radiance,     // pi cos(theta_l) times the BRDF: white is cos(theta_l), as a camera sees it under a distant light
};

/// Unit of the angles in a CSV index. Automatic: degrees; an error if they look like radians.
enum class BtfAngles { automatic, degrees, radians };

/// Color space of the image channels.
enum class BtfColors { rec709, xyz };

struct BtfLoadOptions {
  BtfValues values = BtfValues::automatic;
  BtfColors colors = BtfColors::rec709;
  TransferCurve curve;  // for integer images
  BtfAngles angles = BtfAngles::automatic;
  std::string layer = {};                          // layer of OpenEXR images (PictureOptions)
  std::optional<Vec2> tile_metres = std::nullopt;  // overrides the size given by the source
};

/// Loads one of: a Velour BTF folder or its btf.json; a folder of images named by their angles; a CSV index of images,
/// or a folder that contains one as btf.csv; a .btf file of Bonn (docs/reference/btf_formats.md). Throws Error(io,
/// bad_data, unsupported) with one sentence that names the file and the remedy.
std::shared_ptr<const BtfMeasurement> load_btf(const std::string& path, const BtfLoadOptions& options = {});

/// Whether `path` looks like one of these: a folder, btf.json, a CSV index or a .btf file.
bool is_btf(const std::string& path);

}  // namespace velour
