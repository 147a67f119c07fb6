// A pilot render, in which the strategy `automatic` finds out how each material should mix its light directions.
#pragma once

#include "base/progress.h"
#include "render/tile_renderer.h"

namespace velour {

/// Whether `automatic` is the strategy and the image has so many samples that a pilot takes little of its time.
bool pilot_pays(const RenderContext& context);
/// Whether that pilot tries products, for which RenderContext::sky must be made: it takes seconds the first time.
bool pilot_tries_products(const RenderContext& context);

/// Sets RenderContext::mixing, if pilot_pays(). Renders up to 2048 pixels, spread evenly over the image, with several
/// mixings and two seeds each: half of the squared difference is an unbiased estimate of the variance. Each material
/// gets the mixing with the smallest mean of variance over squared luminance, times its cost; rare materials get the
/// one that is best for all. Occlusion, alpha and bounces are therefore accounted for. The choice depends on neither
/// threads, crop nor range of samples, and its seeds are not those of the render, which stays unbiased. For the calling
/// arena. Throws Error(cancelled).
RenderReport::Pilot choose_mixing(RenderContext& context, const Progress& progress);

}  // namespace velour
