#include "capture/btf/repeated_tile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace velour {
namespace {

constexpr float kTan85 = 11.43f;  // rays up to 85 degrees stay in the region, within kMaxAround periods
constexpr int kMaxAround = 3;
constexpr float kMaxPeriods = 100.0f;  // maximum span of the geometry: every object is instanced once per period

void check_period(float period, char axis) {
  if (std::isfinite(period) && period > 0) return;
  refuse("The tile's period along " + std::string(1, axis) + " is " + std::to_string(period) +
         "; it must be positive.");
}

Bounds bounds_of(const Scene& scene, const Scene::Instance& instance, const Progress& progress) {
  constexpr size_t kPiece = 1 << 18;
  const Mesh& mesh = scene.traced_mesh(instance);
  Bounds bounds;
  for (size_t i = 0; i < mesh.triangles().size(); ++i) {
    if (i % kPiece == 0) progress.check();
    for (int k = 0; k < 3; ++k) bounds.add(instance.object_to_world.point(mesh.positions()[mesh.triangles()[i][k]]));
  }
  return bounds;
}

Affine moved(Affine map, const Vec2& by) {
  map.m[3] += by.x;
  map.m[7] += by.y;
  return map;
}

}  // namespace

TilePlace place_of(const Scene& scene, const TilePlace& given) {
  if (!scene.committed()) throw Error(Status::invalid_state, "The tile's scene is not committed.");
  if (scene.bounds().empty()) {
    throw Error(Status::invalid_argument,
                "The tile is empty: it has no triangles with an area. Give a mesh with faces.");
  }
  if (given.period.x != 0 || given.period.y != 0) return given;
  return {Vec2(scene.bounds().low), Vec2(scene.bounds().high - scene.bounds().low)};
}

RepeatedTile::RepeatedTile(const Scene& scene, const TilePlace& place, int threads, const Progress& progress)
    : scene_(scene), place_(place) {
  check_period(place.period.x, 'x');
  check_period(place.period.y, 'y');
  measure(progress);
  choose_region();
  rays_.share_meshes(scene_.rays());
  add_instances();
  rays_.commit(threads);
}

void RepeatedTile::measure(const Progress& progress) {
  Bounds all;
  for (const Scene::Instance& instance : scene_.instances()) {
    Bounds b = bounds_of(scene_, instance, progress);
    if (!b.empty()) {
      b.low -= Vec3(place_.origin, 0);
      b.high -= Vec3(place_.origin, 0);
      all.add(b.low);
      all.add(b.high);
    }
    bounds_.push_back(b);
  }
  if (all.empty()) refuse("The tile is empty: it has no triangles with an area. Give a mesh with faces.");
  const Vec2 span = Vec2(all.high - all.low) / period();
  if (std::max(span.x, span.y) > kMaxPeriods) {
    refuse("The tile's geometry spans " + std::to_string(std::max(span.x, span.y)) +
           " periods; at most 100 are supported. Check that the period is in scene units.");
  }
  bottom_ = all.low.z;
  top_ = all.high.z;
  margin_ =
      1e-5f * std::max({thickness(), period().x, period().y}) + 1e-6f * std::max(std::abs(bottom_), std::abs(top_));
}

void RepeatedTile::choose_region() {
  for (int axis = 0; axis < 2; ++axis) {
    const float reach = kTan85 * thickness() / period()[axis] + 0.5f;
    around_[axis] = static_cast<int>(std::clamp(std::ceil(reach), 1.0f, static_cast<float>(kMaxAround)));
  }
}

void RepeatedTile::add_instances() {
  // Copies i of an object with low + i P <= end of the region and high + i P >= its start.
  const auto range = [&](int axis, float low, float high) {
    const float p = period()[axis], a = static_cast<float>(around_[axis]);
    return std::pair(static_cast<int>(std::ceil(-a - high / p - 1e-3f)),
                     static_cast<int>(std::floor(a + 1 - low / p + 1e-3f)));
  };
  for (uint32_t i = 0; i < scene_.instances().size(); ++i) {
    if (bounds_[i].empty()) continue;
    const Scene::Instance& instance = scene_.instances()[i];
    const auto [first_x, last_x] = range(0, bounds_[i].low.x, bounds_[i].high.x);
    const auto [first_y, last_y] = range(1, bounds_[i].low.y, bounds_[i].high.y);
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        const Vec2 by = Vec2(static_cast<float>(x), static_cast<float>(y)) * period() - place_.origin;
        rays_.add_instance(instance.traced, moved(instance.object_to_world, by));
        source_.push_back(i);
      }
    }
  }
}

Vec2 RepeatedTile::into_cell(const Vec2& p) const {
  const Vec2 moved = p - glm::floor(p / period()) * period();
  return glm::clamp(moved, Vec2(0), period());
}

Hit RepeatedTile::of_scene(const Hit& hit) const {
  Hit same = hit;
  same.instance = source_[hit.instance];
  return same;
}

SurfacePoint RepeatedTile::surface(const Hit& of_scene) const {
  SurfacePoint point = scene_.surface(of_scene);
  point.position -= Vec3(place_.origin, 0);
  for (int axis = 0; axis < 2; ++axis) {
    // Shifting rounds, so only points are shifted that lie so far off that their own error is larger.
    const float p = period()[axis], x = point.position[axis];
    if (x < -0.5f * p || x > 1.5f * p) point.position[axis] = x - std::floor(x / p) * p;
  }
  return point;
}

RepeatedTile::Ends RepeatedTile::ends(const Vec3& d) const {
  constexpr float kNever = 1e30f;
  Ends ends{};
  for (int axis = 0; axis < 3; ++axis) ends.inverse[axis] = d[axis] == 0 ? kNever : 1 / d[axis];
  const Vec2 around(around_), low = -around * period(), high = (around + 1.0f) * period();
  for (int axis = 0; axis < 2; ++axis) ends.edge[axis] = d[axis] < 0 ? low[axis] : high[axis];
  ends.edge.z = d.z < 0 ? bottom_ - margin_ : top_ + margin_;
  const float longest = (thickness() + 2 * margin_) * std::abs(ends.inverse.z);
  const Vec2 room = (around - 0.5f) * period();
  ends.may_leave = longest * std::abs(d.x) > room.x || longest * std::abs(d.y) > room.y;
  return ends;
}

Vec3 RepeatedTile::entered_again(const Vec3& origin, const Vec3& direction) const {
  Vec3 moved = origin;
  for (int axis = 0; axis < 2; ++axis) {
    const float p = period()[axis];
    const int cell = direction[axis] > 0 ? -around_[axis] : direction[axis] < 0 ? around_[axis] : 0;
    moved[axis] += (static_cast<float>(cell) - std::floor(origin[axis] / p)) * p;
  }
  return moved;
}

void TileRays::cut(Ray& ray, const RepeatedTile::Ends& ends) const {
  ray.far = std::max(0.0f, ends.out_of_shell(ray.origin));
  if (ends.may_leave) ray.far = std::max(0.0f, std::min(ray.far, ends.out_of_region(ray.origin)));
}

bool TileRays::leaves(const Ray& ray, const RepeatedTile::Ends& ends) const {
  return ends.may_leave && ends.out_of_region(ray.origin) < ends.out_of_shell(ray.origin);
}

void TileRays::enter_again(Ray& ray) {
  // The pieces overlap slightly, in a stretch without hits, so that there is no gap between them.
  const float distance = ray.far * (1 - 1e-5f);
  ray.origin = tile_.entered_again(ray.origin + distance * ray.direction, ray.direction);
}

// `trace()` traces pieces_ into piece_*; `met(i, piece)` stores the result of ray i and returns whether it hit
// something.
template <typename Trace, typename Met, typename EndsOf>
void TileRays::follow(std::span<Ray> rays, const Trace& trace, const Met& met, const EndsOf& ends_of) {
  for (int piece = 1; !ids_.empty(); ++piece) {
    if (piece == kMaxPieces) {
      lost_ += ids_.size();
      break;
    }
    pieces_.clear();
    for (const uint32_t i : ids_) {
      enter_again(rays[i]);
      cut(rays[i], ends_of(rays[i]));
      pieces_.push_back(rays[i]);
    }
    trace();
    traced_ += pieces_.size();
    size_t kept = 0;
    for (size_t p = 0; p < pieces_.size(); ++p) {
      if (!met(ids_[p], p) && leaves(pieces_[p], ends_of(pieces_[p]))) ids_[kept++] = ids_[p];
    }
    ids_.resize(kept);
  }
  ids_.clear();
}

void TileRays::intersect(std::span<Ray> rays, std::span<Hit> hits, RayLog* log) {
  const auto ends_of = [&](const Ray& ray) { return tile_.ends(ray.direction); };
  for (Ray& ray : rays) cut(ray, ends_of(ray));
  if (log != nullptr) log->add(rays, RayLog::Kind::nearest);
  tile_.rays().intersect(rays, hits.data());
  traced_ += rays.size();
  for (uint32_t i = 0; i < rays.size(); ++i) {
    if (hits[i].instance == kNoHit && leaves(rays[i], ends_of(rays[i]))) ids_.push_back(i);
  }
  const auto trace = [&] {
    piece_hits_.resize(pieces_.size());
    if (log != nullptr) log->add(pieces_, RayLog::Kind::nearest);
    tile_.rays().intersect(pieces_, piece_hits_.data());
  };
  const auto met = [&](uint32_t i, size_t piece) {
    hits[i] = piece_hits_[piece];
    return hits[i].instance != kNoHit;
  };
  follow(rays, trace, met, ends_of);
}

void TileRays::occluded(std::span<Ray> rays, std::span<uint8_t> blocked, const RepeatedTile::Ends& ends, RayLog* log) {
  for (Ray& ray : rays) cut(ray, ends);
  if (log != nullptr) log->add(rays, RayLog::Kind::coherent_occlusion);
  tile_.rays().occluded_coherent(rays, blocked.data());
  traced_ += rays.size();
  if (!ends.may_leave) return;
  for (uint32_t i = 0; i < rays.size(); ++i) {
    if (blocked[i] == 0 && leaves(rays[i], ends)) ids_.push_back(i);
  }
  const auto trace = [&] {
    piece_blocked_.resize(pieces_.size());
    if (log != nullptr) log->add(pieces_, RayLog::Kind::coherent_occlusion);
    tile_.rays().occluded_coherent(pieces_, piece_blocked_.data());
  };
  const auto met = [&](uint32_t i, size_t piece) { return (blocked[i] = piece_blocked_[piece]) != 0; };
  follow(rays, trace, met, [&](const Ray&) { return ends; });
}

}  // namespace velour
