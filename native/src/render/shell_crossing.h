// Rays at the tops of shells.
#pragma once

#include "scene/scene.h"
#include "votf/shell_trace.h"

namespace velour {

/// What a ray does that crosses the top of a shell, or a side where the surface ends: it comes from outside and goes
/// in, or it leaves after its way through the shell. A way that goes in through the top or a side is decided there, up
/// to where it leaves through any; one that came in through the bottom, or began within, where it leaves.
class ShellCrossing {
 public:
  /// `hit` is on the top or a side of a shell (Scene::has_shell).
  ShellCrossing(const Scene& scene, const Ray& ray, const Hit& hit);

  const ShellField& field() const { return *frame_.field; }
  /// From the shell's bottom to its top, in the world.
  float height() const { return (field().volume().top - field().volume().bottom) / frame_.scale; }
  /// The top's point that the crossing belongs to: `hit`, or the point of the border over it.
  const Hit& top() const { return foot_.top; }
  /// Where the ray could meet the structure on this side of the surface; nowhere when it is empty, from where it begins
  /// to its end.
  const ShellWay& way() const { return way_; }
  /// Whether it does.
  bool find();

  /// The place where it does so, in place of the top's. This and what follows only after find() said so. `shaded`
  /// (SurfaceMaterial::shell_shaded): the structure's own surface, a little off it; else the smooth surface there,
  /// where rays leave the shell.
  SurfacePoint surface(SurfacePoint top, bool shaded) const;
  /// The place's texture coordinates: those of the plane that a BTF of the structure has its texels on, where the ray
  /// crosses it.
  TexturePoint texture(TexturePoint top) const;
  /// From there to its mirror image at the outline that the structure has along the ray, in texture coordinates; zero
  /// where no outline is near in terms of so many `texels` a tile (SurfaceSite::beyond_outline).
  Vec2 beyond_outline(const Vec2& texels) const;

 private:
  ShellRay in_shell() const;
  ShellWay way_at_side(const Ray& ray, const Hit& hit, const ShellEdge& edge);
  void end_at_sides(const Ray& ray, const Hit& hit);
  /// Whether it is met where the side cuts it.
  bool is_cut() const;
  Vec3 cut_normal() const;
  ShellWay way_behind(const ShellRay& ray, const Hit& hit, const ShellEdge& edge) const;
  Vec3 normal() const;
  Vec3 structure_normal(const Vec3& up) const;

  const Scene& scene_;
  const Scene::ShellFoot foot_;
  const Vec3 direction_;  // of the ray, downwards through the shell
  bool leaving_;
  Vec3 crossing_;     // of the top or side
  Vec3 side_normal_;  // outwards, not normalised
  ShellFrame frame_;
  ShellWay way_;
  ShellHit hit_;
};

}  // namespace velour
