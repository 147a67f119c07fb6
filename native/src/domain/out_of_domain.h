// Whether a frame stays within the scene usage that a material's model was reduced to.
#pragma once

#include "domain/observation.h"

namespace velour {

/// Share of the material's weight in the image of `frame` that lies outside: seen from a view outside `range`, or from
/// a view inside it under light more than kSharperLight times as concentrated as in `domain`. 0..1; 0 for a frame that
/// never shows the material.
///
/// The two parts are disjoint, so they add up. The first is computed from the view histogram of all hits, in which a
/// single one of 65,536 camera rays counts. The second is computed from the kept hits, each an independent sample by
/// weight: a true share p is estimated with a standard deviation of sqrt(p (1 - p) / 1024), 0.1 % of the image at p =
/// 0.1 %. Light that sharp on 0.1 % of the weight is missed in 36 frames of 100, on 0.5 % in one of 170.
double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame);

/// For a BTF model that knows only the views of `domain`: share of the weight that is seen from elsewhere
/// (share_from_elsewhere).
double out_of_views(const SceneDomain& domain, const SceneObservation& frame);

/// For a BTF model whose finest level has `texels` along the longer side of the tile: share of the weight that would
/// look up a finer level. Computed from all hits; 1 for a frame that shows the material but has no footprints.
double out_of_resolution(uint32_t texels, const SceneObservation& frame);

}  // namespace velour
