// BSDFs of Radiance and LBNL WINDOW as XML (schema windows.lbl.gov/BSDF-v1.4): matrices over Klems's patches
// [Kle94] and tensor trees [WKB12].
#pragma once

#include <memory>
#include <span>

#include "brdf/measure/measurement.h"

namespace velour {

/// The reflection of the front, or of the back if there is no other. `provenance` has path, name, sha256 and size
/// already. Throws Error(bad_data, unsupported).
std::shared_ptr<const Measurement> read_window_bsdf(std::span<const uint8_t> bytes, Provenance provenance);

}  // namespace velour
