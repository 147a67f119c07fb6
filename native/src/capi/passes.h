// Passes that a render is asked for.
#pragma once

#include "render/pass_options.h"
#include "velour/velour.h"

namespace velour::capi {

/// NULL: none. Throws Error(invalid_argument, version_mismatch).
PassOptions passes_of(const vlr_pass_options* given);

}  // namespace velour::capi
