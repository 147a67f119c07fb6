// Fits of skies kept between renders, by the content of the image. Internal to scene/.
#pragma once

#include <optional>
#include <string>

#include "scene/sky_mixture.h"

namespace velour {

/// "FOLDER/sky-<SHA-256 of size, texels and options>.exr": texels as radiance, so another strength is another file and
/// another rotation the same.
std::string sky_cache_path(const std::string& folder, const EquirectangularImage& image, const SkyFitOptions& options);

/// Nothing when there is no such file or when it is not, in every entry, a mixture: it is then fitted anew.
std::optional<SkyMixture> read_sky(const std::string& path);

/// Atomic. False when it could not be written.
bool write_sky(const std::string& path, const SkyMixture& sky);

}  // namespace velour
