// Depth of rays within a structure.
#pragma once

#include "votf/eval/shell_trace.h"

namespace velour {

struct ShellDepth {
  float depth;  // tile widths; negative: distance outside
  float s;      // meters past the crossing
};

/// Deepest point of a way between `from`, meters past the crossing, and its end, sampled a pitch apart or at
/// kMaxDepthLooks points, whichever is coarser. Stops once the depth reaches `most`.
ShellDepth deepest_behind(const ShellField& field, const ShellWay& way, float from, float most);

inline constexpr int kMaxDepthLooks = 256;

/// Silhouette of the structure beside a ray, relative to the point where the ray hits the structure.
struct ShellOutline {
  float depth;   // maximum depth within the structure past that point, tile widths; not below `most`: no silhouette
  Vec3 outside;  // tile, unit: toward the nearest outside, perpendicular to the ray; zero if there is none
};
ShellOutline outline_beside(const ShellField& field, const ShellWay& way, float s, float most);

}  // namespace velour
