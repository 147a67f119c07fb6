// Rays through the shell of a curved surface, and their depth within the structure.
#pragma once

#include <cstdint>
#include <span>
#include "votf/eval/occlusion_volume.h"

namespace velour {

/// A straight world-space ray that crosses the top of a shell downward, or a side of it, as seen from the surface: the
/// shell is the tile's, bent with the normal curvature of the surface in the plane of the ray, so the ray is an arc
/// that may leave through the top again. Exact on spheres and, along their principal directions, on cylinders; twist is
/// neglected.
struct ShellRay {
  Vec2 place;        // crossing point, tile widths
  Vec2 along;        // horizontal direction, tile widths per meter on the surface at the crossing's height
  float cosine;      // cosine of the angle with the downward normal: in [0, 1] at the top, from -1 at a side
  float curvature;   // normal curvature at the crossing's height in the plane of the ray, 1/m; positive: convex
  float scale;       // tile widths per meter along the normal
  float height = 0;  // height of the crossing, tile widths from the top: 0, or below at a side

  /// Point `s` meters past the crossing (negative: before it), in tile widths, with z relative to the top.
  Vec3 at(float s) const;
};

/// Extent of a ray within the shell.
struct ShellSpan {
  float end;            // meters past the crossing
  bool through_bottom;  // false: it leaves through the top again
};
ShellSpan span_of(const ShellRay& ray, const VotfVolume& volume);
/// Extent of a ray that crosses a side, forward (`onwards`) or backward; infinite if it stays within.
ShellSpan span_from_side(const ShellRay& ray, const VotfVolume& volume, bool onwards);

/// Sine of the ray's angle with the normal.
float sine_of(const ShellRay& ray);

/// Soft edge of a structure: each ray sees the edge displaced by its own offset, uniform over `softness` tile widths.
struct ShellEdge {
  float softness = 0;
  float offset = 0;  // positive: outward
};

/// Segment of a ray along which the structure is searched for.
struct ShellWay {
  /// From `begin` to `end`, meters past the crossing, in either order. A ray that `starts_on` the structure may seem to
  /// begin inside it, because the point was found along another ray, and arcs agree only to about a pitch. Its search
  /// starts where it comes out, or at `begin` if it is deeper inside.
  ShellWay() = default;
  ShellWay(const ShellRay& ray, const VotfVolume& volume, float begin, float end, bool starts_on = false,
           const ShellEdge& edge = {});

  bool empty() const { return begin == end; }

  ShellRay ray;
  float begin, end;
  float sine;    // sine of the ray's angle with the normal
  float speed;   // maximum number of tile widths covered per meter
  float own;     // meters of the way that may lie in the structure it starts on
  float offset;  // ShellEdge::offset
};

/// The first point on a way where the ray is within the structure.
struct ShellHit {
  bool met;     // false: there is none; `s` and `place` are undefined
  float begin;  // ShellWay::begin, or where the ray left the structure it started on
  float s;      // meters past the crossing
  Vec3 place;   // tile widths
  explicit operator bool() const { return met; }
};

/// Sphere tracing [Har96] with over-relaxed steps [KSK14], vectorized over rays. Writes one hit per way; the result for
/// a way does not depend on the other ways.
void trace_shells(const ShellField& field, std::span<const ShellWay> ways, ShellHit* hits);
ShellHit trace_shell(const ShellField& field, const ShellWay& way);

inline constexpr float kWithinShell = 0.03f;  // pitches: nearer to the structure than this counts as inside
inline constexpr float kMinShellStep = 0.1f;  // pitches: minimum step
inline constexpr float kShellStride = 1.6f;   // step length as a multiple of the distance [KSK14]
inline constexpr int kMaxShellLooks = 4096;   // a ray that glides along a surface for so long counts as a hit

/// The line along unit `w`, w.z not 0, through `place` (tile widths) on the reference plane of a flat shell.
ShellWay line_through(const VotfVolume& volume, const Vec2& place, const Vec3& w);

/// V of points: 1 where the line through one of `places` along `w` meets the structure, otherwise 0.
void lines_meet(const ShellField& field, std::span<const Vec2> places, const Vec3& w, uint8_t* meets);
bool line_meets(const ShellField& field, const Vec2& place, const Vec3& w);

// Vectorized look-ups and ray marching in a shell.

/// ShellField::distance at each of `places`.
void shell_distances(const ShellTable& table, std::span<const Vec3> places, float* distance);

/// trace_shells() for at most kWaysTogether ways.
inline constexpr size_t kWaysTogether = 256;
void march_shells(const ShellTable& table, std::span<const ShellWay> ways, ShellHit* hits);

/// Implementation of ShellRay::at.
Vec3 place_on_ray(const ShellRay& ray, float s);

// Depth of rays within a structure.

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
