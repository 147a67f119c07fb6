// The density of a GGX sampler at many directions.
#pragma once

#include "material/ggx_sampler.h"

namespace velour {

/// pdf[i] = cosine_share max(wl.z, 0) / pi + lobe_scale (|s|^2 / ggx_spread(s))^2 where s = wl + wv points up, which is
/// pdf_ggx_reflection without a square root: spread and |s|^2 grow alike, so the half vector is not normalised. The
/// batch is padded. Run-time dispatched SIMD.
void ggx_mixture_pdf(const GgxPoint& point, const Vec2& alpha, const DirectionBatch& wl, ScalarBatch& pdf);

}  // namespace velour
