// Rays at the tops and sides of shells.
#pragma once

#include "scene/scene.h"
#include "votf/eval/shell_trace.h"

namespace velour {

/// A ray that crosses the top of a shell, or a side where the surface ends: it enters from outside, or it leaves after
/// its way through the shell. A way that enters through the top or a side is decided there, up to wherever it leaves;
/// one that came in through the bottom, or began inside, is decided where it leaves.
class ShellCrossing {
 public:
  /// `hit` is on the top or a side of a shell (Scene::has_shell).
  ShellCrossing(const Scene& scene, const Ray& ray, const Hit& hit);

  const ShellField& field() const { return *frame_.field; }
  /// Height of the shell from bottom to top, in the world.
  float height() const { return (field().volume().top - field().volume().bottom) / frame_.scale; }
  /// Point of the top that the crossing belongs to: `hit`, or the point of the border above it.
  const Hit& top() const { return foot_.top; }
  /// Segment on which the ray could hit the structure on this side of the surface; empty if there is none.
  const ShellWay& way() const { return way_; }
  /// Searches the way; returns whether the ray hits the structure.
  bool find();

  /// The hit, in place of the point of the top. Like the functions below, valid only after find() returned true.
  /// `shaded` (SurfaceMaterial::shell_shaded): on the structure's own surface, a little off it; otherwise on the smooth
  /// surface where rays leave the shell.
  SurfacePoint surface(SurfacePoint top, bool shaded) const;
  /// Texture coordinates of the hit: those of the point where the ray crosses the plane of the texels of a BTF.
  TexturePoint texture(TexturePoint top) const;
  /// Vector from there to its mirror image at the silhouette of the structure along the ray, in texture coordinates;
  /// zero if no silhouette is near at a resolution of `texels` per tile (SurfaceSite::beyond_outline).
  Vec2 beyond_outline(const Vec2& texels) const;

 private:
  ShellRay in_shell() const;
  void flatten(const Ray& ray, const Hit& hit);
  ShellWay way_at_side(const Ray& ray, const Hit& hit, const ShellEdge& edge);
  void end_at_sides(const Ray& ray, const Hit& hit);
  /// Whether the hit is where the side cuts the structure.
  bool is_cut() const;
  Vec3 cut_normal() const;
  ShellWay way_behind(const ShellRay& ray, const Hit& hit, const ShellEdge& edge) const;
  Vec3 normal() const;
  Vec3 structure_normal(const Vec3& up) const;

  const Scene& scene_;
  const Scene::ShellFoot foot_;
  const Vec3 direction_;  // direction of the ray, flipped to point down through the shell
  bool leaving_;
  Vec3 crossing_;     // point on the top or side
  Vec3 side_normal_;  // outward, not normalized
  ShellFrame frame_;
  ShellWay way_;
  ShellHit hit_;
};

}  // namespace velour
