// Rays through the shell of a curved surface.
#pragma once

#include <optional>

#include "votf/shell_field.h"

namespace velour {

/// A straight ray of the world where it crosses the top of a shell downwards, seen from the surface: the shell is the
/// tile's, bent with the normal curvature that the surface has in the ray's plane, so the ray is an arc that may leave
/// through the top again. Exact on spheres and, along their principal directions, on cylinders; twist is left out.
struct ShellRay {
  Vec2 place;       // where it crosses the top, widths of the tile
  Vec2 along;       // widths that a metre of the top surface along the ray covers
  float cosine;     // of its angle with the normal, in [0, 1]
  float curvature;  // of the top in its plane, 1 / metres; positive: convex
  float scale;      // widths that a metre along the normal covers

  /// Where it is, in widths from the top, `s` metres behind the crossing; before it where s is negative.
  Vec3 at(float s) const;
};

/// Where a ray is within the shell.
struct ShellSpan {
  float end;            // metres behind the crossing
  bool through_bottom;  // else it leaves through the top again
};
ShellSpan span_of(const ShellRay& ray, const OcclusionVolume& volume);

struct ShellHit {
  float s;     // metres behind the crossing
  Vec3 place;  // widths
};

/// The first place on the way from `begin` to `end`, metres behind the crossing, either before the other, where the ray
/// is within the structure. By sphere tracing [Har96] with long steps [KSK14].
std::optional<ShellHit> trace_shell(const ShellField& field, const ShellRay& ray, float begin, float end);

/// Where a ray that starts on the structure, at `begin`, is outside of it, on the way to `end`. The place where it
/// starts was found along another ray, and arcs agree about it to a pitch or so only; `begin`, if it is deeper inside.
float off_structure(const ShellField& field, const ShellRay& ray, float begin, float end);

/// How deep within the structure, widths, a ray comes that meets it at `s`, on its way to `end`; not more than `most`.
struct ShellDepth {
  float depth;
  Vec3 normal;  // tile: towards the nearest outside, across the ray
};
ShellDepth depth_behind(const ShellField& field, const ShellRay& ray, float s, float end, float most);

/// Whether the line through `place` (widths) of the reference plane of a flat shell along unit `w`, w.z not 0, meets
/// the structure: V of a point.
bool line_meets(const ShellField& field, const Vec2& place, const Vec3& w);

}  // namespace velour
