// Surfaces that are there only in part.
#pragma once

#include <span>
#include <vector>

#include "capture/repeated_tile.h"
#include "render/footprint.h"

namespace velour {

/// Lets rays through surfaces by chance, each with 1 - Material::alpha, which is right on average however many they
/// cross. One a thread.
class Cutouts {
 public:
  explicit Cutouts(const RepeatedTile& tile);

  /// Whether any material of the tile lets rays through: no ray needs the calls below otherwise.
  bool any() const { return any_; }
  /// What TileRays::intersect found for `rays`, but for what lets them through: those rays go on, and `hits` are their
  /// next ones. The random numbers of rays[i] come from keys[i]; `cone` is what the rays stand for.
  void pass(std::span<Ray> rays, std::span<Hit> hits, std::span<const uint64_t> keys, const RayCone& cone,
            TileRays& tracer, RayLog* log);

  /// More surfaces than any ray crosses: what they let through then is lost.
  static constexpr int kMostCrossings = 4096;

 private:
  bool goes_on(const Ray& ray, const Hit& hit, uint64_t key, int crossing, const RayCone& cone, Vec3& from) const;

  const RepeatedTile& tile_;
  bool any_ = false;
  std::vector<uint32_t> ids_;
  std::vector<Ray> next_;
  std::vector<Hit> next_hits_;
};

}  // namespace velour
