// Irregular isotropic spectral samples as text: the .brdf files of Cornell's goniometer and of pbrt-v2.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "brdf/measure/measurement.h"

namespace velour {

/// True for text whose first numbers are a count and a plausible wavelength (nm). '#' begins a comment.
bool looks_like_cornell(std::string_view head);

/// `provenance` has path, name, sha256 and size already. Throws Error(cancelled) once `progress` is canceled:
/// interpolating the samples takes seconds.
std::shared_ptr<const Measurement> read_cornell(std::span<const uint8_t> bytes, Provenance provenance,
                                                const Progress& progress = Progress());

}  // namespace velour
