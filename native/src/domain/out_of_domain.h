// Whether a frame stays within the domain that a material's model was reduced to.
#pragma once

#include "domain/observation.h"

namespace velour {

/// Share of the material's weight in the picture of `frame` that lies outside: seen at a view outside `range`, or at a
/// view inside it under light more than kSharperLight times as concentrated as `domain` knows it. 0..1; 0 for a frame
/// that never shows the material.
///
/// The two parts are disjoint, so they add up. The first comes from the histogram of views, of all hits: one camera ray
/// in 65,536 counts. The second comes from the kept hits, of which each
/// is an independent draw by weight: a true share p is found with the deviation sqrt(p (1 - p) / 1024), 0.1 % of the
/// picture at p = 0.1 %. Of light that sharp on 0.1 % of the weight no hit tells in 36 frames of 100, on 0.5 % in one
/// of 170.
double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame);

/// Of a model of a BTF that knows the views of `domain` alone: the share of the weight that is seen from elsewhere
/// (share_from_elsewhere).
double out_of_views(const SceneDomain& domain, const SceneObservation& frame);

/// The same of a model of a BTF whose finest level has `texels` along the longer side of the tile: the share of the
/// weight that would look up a finer level. From all hits; 1 for a frame that shows the material, but says nothing of
/// footprints.
double out_of_resolution(uint32_t texels, const SceneObservation& frame);

}  // namespace velour
