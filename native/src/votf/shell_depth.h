// How deep within a structure rays come.
#pragma once

#include "votf/shell_trace.h"

namespace velour {

struct ShellDepth {
  float depth;  // widths; negative: how far outside
  float s;      // metres behind the crossing
};

/// The deepest place of a way from `from`, metres behind the crossing, to its end: of places a pitch apart, or of
/// kMostDepthLooks. Once they are deeper than `most`, what lies further on is left out.
ShellDepth deepest_behind(const ShellField& field, const ShellWay& way, float from, float most);

inline constexpr int kMostDepthLooks = 256;

/// To an outline of the structure along a ray, seen from the place where the ray meets it.
struct ShellOutline {
  float depth;   // how deep within the structure the ray comes behind that place, widths; `most`, or deeper, if so
  Vec3 outside;  // tile, unit: towards the nearest outside, across the ray; zero where there is none
};
ShellOutline outline_beside(const ShellField& field, const ShellWay& way, float s, float most);

}  // namespace velour
