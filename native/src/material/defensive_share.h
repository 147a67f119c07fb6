// Share of samples reserved for directions that tables and lobes miss.
#pragma once

namespace velour {

/// Probability of plain cosine sampling, so that the density is positive wherever f may be.
inline constexpr float kDefensiveShare = 0.05f;

}  // namespace velour
