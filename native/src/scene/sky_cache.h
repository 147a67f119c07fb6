// Disk cache of environment fits, keyed by the content of the image. Internal to scene/.
#pragma once

#include <optional>
#include <string>

#include "scene/sky_mixture.h"

namespace velour {

/// "FOLDER/sky-<SHA-256 of size, texels and options>.exr". The texels do not include the placement, so one file serves
/// every strength and rotation.
std::string sky_cache_path(const std::string& folder, const EquirectangularImage& image, const SkyFitOptions& options);

/// Empty if the file is missing or any of its entries is invalid; the caller then fits again.
std::optional<SkyMixture> read_sky(const std::string& path);

/// Writes atomically. Returns false if the file cannot be written.
bool write_sky(const std::string& path, const SkyMixture& sky);

}  // namespace velour
