// The adaptive parameterization of the RGL material database [RGL].
#pragma once

#include <memory>
#include <span>

#include "brdf/measurement.h"

namespace velour {

/// True for bytes that begin like the tensor container of .bsdf files.
bool looks_like_rgl(std::span<const uint8_t> head);

/// `provenance` has path, name, sha256 and size already. Colors come from "rgb", else from "spectra" and "wavelengths".
std::shared_ptr<const Measurement> read_rgl(std::span<const uint8_t> bytes, Provenance provenance);

}  // namespace velour
