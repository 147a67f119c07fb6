// A tile of geometry, repeated without end in x and y.
#pragma once

#include <span>
#include <vector>

#include "job/progress.h"
#include "render/ray_log.h"
#include "scene/scene.h"

namespace velour {

/// Where one period lies in the scene's xy-plane, in its units: [origin, origin + period).
struct TilePlace {
  Vec2 origin{0, 0};
  Vec2 period{0, 0};
};

/// The place with a period of 0 filled in from the geometry's bounding box. Throws Error(invalid_state) for a scene
/// that is not committed, Error(invalid_argument) for one that is empty.
TilePlace place_of(const Scene& scene, const TilePlace& given);

/// Local coordinates: the scene's, with the place's origin at 0. The centre cell is [0, period); what sticks out of it
/// is there as well, and repeats. Immutable, thread-safe.
///
/// Every object is instanced wherever it reaches into a region of whole periods about the centre cell; no geometry is
/// copied. Rays are cut where they leave the shell, the range of heights that holds geometry; those that leave the
/// region before come in again, shifted by whole periods (TileRays). So a ray of any angle meets what it would meet on
/// the endless surface.
class RepeatedTile {
 public:
  /// `scene` is committed and outlives this; its meshes are shared. Throws Error(invalid_argument) when it is empty, or
  /// when a period is not positive or less than a hundredth of what the geometry spans.
  RepeatedTile(const Scene& scene, const TilePlace& place, int threads, const Progress& progress = Progress());

  const Scene& scene() const { return scene_; }
  const EmbreeScene& rays() const { return rays_; }
  const TilePlace& place() const { return place_; }
  Vec2 period() const { return place_.period; }
  /// The lowest and the highest point of the geometry.
  float bottom() const { return bottom_; }
  float top() const { return top_; }
  float thickness() const { return top_ - bottom_; }

  /// A hit of rays() as the scene's own.
  Hit of_scene(const Hit& hit) const;
  /// Surface of a hit of the scene's, moved by whole periods to be in or near the centre cell.
  SurfacePoint surface(const Hit& of_scene) const;
  /// The same place of the centre cell.
  Vec2 into_cell(const Vec2& p) const;

  /// Where rays of one direction end, as planes to compare with.
  struct Ends {
    Vec3 edge, inverse;  // plane of each axis ahead, and 1 / the direction's component
    bool may_leave;      // the region before the shell
    float out_of_shell(const Vec3& origin) const { return (edge.z - origin.z) * inverse.z; }
    float out_of_region(const Vec3& origin) const {
      return std::min((edge.x - origin.x) * inverse.x, (edge.y - origin.y) * inverse.y);
    }
  };
  /// For origins within half a period of the centre cell.
  Ends ends(const Vec3& direction) const;
  /// A ray at `origin` that is about to leave the region goes on from here.
  Vec3 entered_again(const Vec3& origin, const Vec3& direction) const;

 private:
  void measure(const Progress& progress);
  void choose_region();
  void add_instances();

  const Scene& scene_;
  TilePlace place_;
  std::vector<Bounds> bounds_;  // of each instance of the scene, local
  float bottom_ = 0, top_ = 0;
  float margin_ = 0;         // beyond the shell, and between a border and what it is compared with
  glm::ivec2 around_{1, 1};  // whole periods of the region on each side of the centre cell
  EmbreeScene rays_;
  std::vector<uint32_t> source_;  // of each instance here: its number in the scene
};

/// Traces rays over a tile. One a thread.
class TileRays {
 public:
  explicit TileRays(const RepeatedTile& tile) : tile_(tile) {}

  /// First hits, for rays that start in or near the centre cell; Hit::distance is that of the last piece. `rays` are
  /// cut. `log` may be null.
  void intersect(std::span<Ray> rays, std::span<Hit> hits, RayLog* log);
  /// Whether rays of one direction, neighbours in space, meet anything.
  void occluded(std::span<Ray> rays, std::span<uint8_t> blocked, const RepeatedTile::Ends& ends, RayLog* log);

  /// Rays traced, each piece counted; rays that ran within the shell over kMostPieces regions, taken to meet nothing.
  uint64_t traced() const { return traced_; }
  uint64_t lost() const { return lost_; }

  static constexpr int kMostPieces = 256;

 private:
  void cut(Ray& ray, const RepeatedTile::Ends& ends) const;
  bool leaves(const Ray& ray, const RepeatedTile::Ends& ends) const;
  void enter_again(Ray& ray);
  template <typename Trace, typename Met, typename EndsOf>
  void follow(std::span<Ray> rays, const Trace& trace, const Met& met, const EndsOf& ends_of);

  const RepeatedTile& tile_;
  uint64_t traced_ = 0, lost_ = 0;
  std::vector<Ray> pieces_;  // of rays that entered again
  std::vector<uint32_t> ids_;
  std::vector<Hit> piece_hits_;
  std::vector<uint8_t> piece_blocked_;
};

}  // namespace velour
