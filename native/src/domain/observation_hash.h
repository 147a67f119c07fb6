// Content hash of an observation.
#pragma once

#include "domain/observation.h"

namespace velour {

/// SHA-256 of the view histogram, the light density, the surface usage if there is any, and the hits with their terms,
/// as four words. For the domain of one frame; merging adds the words up.
std::array<uint64_t, 4> content_hash(const SceneObservation& observation);

}  // namespace velour
