// Passes requested from a render.
#pragma once

#include "render/pass_options.h"
#include "velour/velour.h"

namespace velour::capi {

/// `given` NULL: no passes. Throws Error(invalid_argument, version_mismatch).
PassOptions passes_of(const vlr_pass_options* given);

}  // namespace velour::capi
