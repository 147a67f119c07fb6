// How much samplers keep back for directions that their tables and lobes miss.
#pragma once

namespace velour {

/// Share of directions sampled by the cosine alone: the density is positive wherever f may be.
inline constexpr float kDefensiveShare = 0.05f;

}  // namespace velour
