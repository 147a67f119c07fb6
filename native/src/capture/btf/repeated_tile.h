// A tile of geometry, repeated infinitely in x and y.
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "render/ray_log.h"
#include "scene/scene.h"

namespace velour {

/// One period in the scene's xy-plane, in scene units: [origin, origin + period).
struct TilePlace {
  Vec2 origin{0, 0};
  Vec2 period{0, 0};
};

/// Returns `given`, or the geometry's bounding box if its period is (0, 0). Throws Error(invalid_state) for a scene
/// that is not committed, Error(invalid_argument) for an empty one.
TilePlace place_of(const Scene& scene, const TilePlace& given);

/// Local coordinates: the scene's, with the place's origin at 0. The center cell is [0, period); geometry that sticks
/// out of it is kept and repeats as well. Immutable, thread-safe.
///
/// Every object is instanced wherever it reaches into a region of whole periods around the center cell; no geometry is
/// copied. Rays are cut where they leave the shell, the range of heights that holds geometry; rays that leave the
/// region earlier re-enter it, shifted by whole periods (TileRays). So a ray at any angle hits what it would hit on the
/// infinite surface.
class RepeatedTile {
 public:
  /// `scene` must be committed and outlive this; its meshes are shared. Throws Error(invalid_argument) if it is empty,
  /// or if a period is not positive or less than a hundredth of the geometry's extent.
  RepeatedTile(const Scene& scene, const TilePlace& place, int threads, const Progress& progress = Progress());

  const Scene& scene() const { return scene_; }
  const EmbreeScene& rays() const { return rays_; }
  const TilePlace& place() const { return place_; }
  Vec2 period() const { return place_.period; }
  /// The lowest and the highest point of the geometry.
  float bottom() const { return bottom_; }
  float top() const { return top_; }
  float thickness() const { return top_ - bottom_; }

  /// Converts a hit of rays() to a hit of the scene.
  Hit of_scene(const Hit& hit) const;
  /// Surface at a hit of the scene, shifted by whole periods into or near the center cell.
  SurfacePoint surface(const Hit& of_scene) const;
  /// Shifts `p` by whole periods into the center cell.
  Vec2 into_cell(const Vec2& p) const;

  /// Planes at which rays of one direction end.
  struct Ends {
    Vec3 edge, inverse;  // plane ahead on each axis, and 1 / the direction's component
    bool may_leave;      // whether rays may leave the region before the shell
    float out_of_shell(const Vec3& origin) const { return (edge.z - origin.z) * inverse.z; }
    float out_of_region(const Vec3& origin) const {
      return std::min((edge.x - origin.x) * inverse.x, (edge.y - origin.y) * inverse.y);
    }
  };
  /// Valid for origins within half a period of the center cell.
  Ends ends(const Vec3& direction) const;
  /// Where a ray at `origin` that is about to leave the region re-enters it.
  Vec3 entered_again(const Vec3& origin, const Vec3& direction) const;

 private:
  void measure(const Progress& progress);
  void choose_region();
  void add_instances();

  const Scene& scene_;
  TilePlace place_;
  std::vector<Bounds> bounds_;  // of each instance of the scene, local
  float bottom_ = 0, top_ = 0;
  float margin_ = 0;         // above and below the geometry, against rounding
  glm::ivec2 around_{1, 1};  // whole periods of the region on each side of the center cell
  EmbreeScene rays_;
  std::vector<uint32_t> source_;  // index in the scene of each instance here
};

/// Traces rays over a tile. One per thread.
class TileRays {
 public:
  explicit TileRays(const RepeatedTile& tile) : tile_(tile) {}

  /// Finds first hits, for rays that start in or near the center cell. `rays` become their last pieces, which
  /// Hit::distance refers to. `log` may be null.
  void intersect(std::span<Ray> rays, std::span<Hit> hits, RayLog* log);
  /// Finds whether rays of one direction, neighbors in space, hit anything.
  void occluded(std::span<Ray> rays, std::span<uint8_t> blocked, const RepeatedTile::Ends& ends, RayLog* log);

  /// Numbers of rays traced, counting each piece, and of rays lost: still in the shell after kMaxPieces regions, which
  /// count as misses.
  uint64_t traced() const { return traced_; }
  uint64_t lost() const { return lost_; }

  static constexpr int kMaxPieces = 256;

 private:
  void cut(Ray& ray, const RepeatedTile::Ends& ends) const;
  bool leaves(const Ray& ray, const RepeatedTile::Ends& ends) const;
  void enter_again(Ray& ray);
  template <typename Trace, typename Met, typename EndsOf>
  void follow(std::span<Ray> rays, const Trace& trace, const Met& met, const EndsOf& ends_of);

  const RepeatedTile& tile_;
  uint64_t traced_ = 0, lost_ = 0;
  std::vector<Ray> pieces_;  // of rays that re-entered
  std::vector<uint32_t> ids_;
  std::vector<Hit> piece_hits_;
  std::vector<uint8_t> piece_blocked_;
};

}  // namespace velour
