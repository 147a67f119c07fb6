// Rays through the shell of a curved surface.
#pragma once

#include <cstdint>
#include <span>

#include "votf/shell_field.h"

namespace velour {

/// A straight ray of the world where it crosses the top of a shell downwards, or a side of it, seen from the surface:
/// the shell is the tile's, bent with the normal curvature that the surface has in the ray's plane, so the ray is an
/// arc that may leave through the top again. Exact on spheres and, along their principal directions, on cylinders;
/// twist is left out.
struct ShellRay {
  Vec2 place;        // where it crosses, widths of the tile
  Vec2 along;        // widths that a metre along the ray covers of the surface at the crossing's height
  float cosine;      // of its angle with the normal, downwards: in [0, 1] at the top, from -1 at a side
  float curvature;   // of the surface at the crossing's height in its plane, 1 / metres; positive: convex
  float scale;       // widths that a metre along the normal covers
  float height = 0;  // of the crossing, widths from the top: 0, or below at a side

  /// Where it is, in widths from the top, `s` metres behind the crossing; before it where s is negative.
  Vec3 at(float s) const;
};

/// Where a ray is within the shell.
struct ShellSpan {
  float end;            // metres behind the crossing
  bool through_bottom;  // else it leaves through the top again
};
ShellSpan span_of(const ShellRay& ray, const OcclusionVolume& volume);
/// The same of a ray that crosses a side, `onwards` or back; infinite where it stays within.
ShellSpan span_from_side(const ShellRay& ray, const OcclusionVolume& volume, bool onwards);

/// Of the ray's angle with the normal.
float sine_of(const ShellRay& ray);

/// A structure whose edge each ray finds elsewhere, at an offset of its own, uniform over `softness` widths about it.
struct ShellEdge {
  float softness = 0;
  float offset = 0;  // positive: outwards
};

/// Where along a ray the structure is looked for.
struct ShellWay {
  /// From `begin` to `end`, metres behind the crossing, either before the other. A ray that `starts_on` the structure
  /// may seem to begin within it, because the place was found along another ray, and arcs agree about it to a pitch or
  /// so only: such a one is looked for from where it comes out; from `begin`, if it is deeper inside.
  ShellWay() = default;
  ShellWay(const ShellRay& ray, const OcclusionVolume& volume, float begin, float end, bool starts_on = false,
           const ShellEdge& edge = {});

  bool empty() const { return begin == end; }

  ShellRay ray;
  float begin, end;
  float sine;    // of the ray's angle with the normal
  float speed;   // widths that the ray covers a metre, at most
  float own;     // metres of the way that may lie in the structure it starts on
  float offset;  // of the edge
};

/// The first place on a way where the ray is within the structure.
struct ShellHit {
  bool met;     // false: there is none, and `s` and `place` mean nothing
  float begin;  // ShellWay::begin, or where the ray came out of what it started on
  float s;      // metres behind the crossing
  Vec3 place;   // widths
  explicit operator bool() const { return met; }
};

/// By sphere tracing [Har96] with long steps [KSK14], as many rays side by side as the processor has lanes. One `hit` a
/// way; what becomes of a way does not depend on the others.
void trace_shells(const ShellField& field, std::span<const ShellWay> ways, ShellHit* hits);
ShellHit trace_shell(const ShellField& field, const ShellWay& way);

inline constexpr float kWithinShell = 0.03f;    // pitches: nearer to the structure than this is within
inline constexpr float kLeastShellStep = 0.1f;  // pitches: no step is shorter
inline constexpr float kShellStride = 1.6f;     // distances that a step is long [KSK14]
inline constexpr int kMostShellLooks = 4096;    // a ray that glides along a surface for so long has met it

/// The line through `place` (widths) of the reference plane of a flat shell along unit `w`, w.z not 0.
ShellWay line_through(const OcclusionVolume& volume, const Vec2& place, const Vec3& w);

/// Whether the lines through `places` along `w` meet the structure: V of points, 0 or 1 each.
void lines_meet(const ShellField& field, std::span<const Vec2> places, const Vec3& w, uint8_t* meets);
bool line_meets(const ShellField& field, const Vec2& place, const Vec3& w);

}  // namespace velour
