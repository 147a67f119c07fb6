// How fast a material is evaluated.
#pragma once

#include "material/material.h"

namespace velour {

/// Evaluations a second of one thread: a random place, view and light each, at the finest level (bilinear, no
/// footprint); the median of five runs.
double evaluation_rate(const Material& material);

}  // namespace velour
