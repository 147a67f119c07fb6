// Density of GgxSampler over a batch of directions.
#pragma once

#include "material/microfacet/ggx_sampler.h"

namespace velour {

/// pdf[i] = cosine_share max(wl.z, 0) / pi + lobe_scale (|s|^2 / ggx_spread(s))^2 where s = wl + wv points up. The
/// second term is pdf_ggx_reflection without a square root: spread and |s|^2 scale alike, so s is not normalized. The
/// batch is padded. SIMD, dispatched at run time.
void ggx_mixture_pdf(const GgxPoint& point, const Vec2& alpha, const DirectionBatch& wl, ScalarBatch& pdf);

}  // namespace velour
