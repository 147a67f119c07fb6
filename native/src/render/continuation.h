// Continuation rays of paths.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>
#include "math/sphere/random.h"
#include "render/direction_sampling.h"

namespace velour {

struct Continuation {
  Ray ray;
  Rgb throughput;
  Vec3 wl;        // local
  float density;  // sampling density, per solid angle
};

/// f of the vertex's material in the scene's working space, with its gain.
inline Rgb in_working_space(const std::optional<Mat3>& rec709_to_working, const Vertex& vertex, const Rgb& f) {
  const SurfaceMaterial& surface = *vertex.surface;
  return surface.gain * (rec709_to_working && surface.rec709_colors ? *rec709_to_working * f : f);
}

/// Continuation along a direction that was sampled from the surface with density `pdf`; `reflected`: f times the
/// throughput so far. Empty if it would go below the surface or carry nothing.
std::optional<Continuation> continuation_along(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                               const Rgb& reflected, float pdf);

/// Continuation sampled from the surface with `u`, with throughput `throughput` f cos / pdf, which need not be finite.
/// Empty if it would go below the surface or carry nothing. `prepared`: surface at the vertex.
std::optional<Continuation> sample_continuation(const Vertex& vertex, const PreparedSurface& prepared,
                                                const std::optional<Mat3>& rec709_to_working, const Rgb& throughput,
                                                const Vec2& u);

// Independent samples from a stream of items, each with probability proportional to its weight.

/// Every item receives the times of a Poisson process whose rate is its weight. The `count` earliest times of all are
/// kept, and the items they belong to are the samples: the marks of superposed Poisson processes are independent, with
/// probabilities proportional to the rates [Kin93 chapters 2 and 5]. (Keeping only the first time of each item would be
/// the reservoir of [ES06]: sampling without replacement, in which heavy items get less than their share.) The outcome
/// depends on the items but not on their order, so parts may be sampled separately and merged.
template <typename Item>
class DrawByWeight {
 public:
  explicit DrawByWeight(size_t count) : count_(count) {}

  struct Draw {
    uint64_t key;  // bits of the time; they sort like the times
    Item item;
  };

  /// `numbers`: random numbers of this item alone.
  void add(const Item& item, double weight, RandomStream numbers) {
    double time = 0;
    for (size_t i = 0; i < count_; ++i) {
      time -= std::log1p(-unit_double(numbers.next_bits())) / weight;
      const auto key = std::bit_cast<uint64_t>(time);
      if (key >= latest_) return;
      draws_.push_back({key, item});
      if (draws_.size() >= 2 * count_) trim();
    }
  }
  void add(const DrawByWeight& other) {
    draws_.insert(draws_.end(), other.draws_.begin(), other.draws_.end());
    if (draws_.size() > count_) trim();
  }
  /// The samples in ascending order of their keys.
  std::vector<Draw> sorted() const {
    std::vector<Draw> draws = draws_;
    std::ranges::sort(draws, {}, &Draw::key);
    if (draws.size() > count_) draws.erase(draws.begin() + static_cast<std::ptrdiff_t>(count_), draws.end());
    return draws;
  }

 private:
  static double unit_double(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
  void trim() {
    const auto last = draws_.begin() + static_cast<std::ptrdiff_t>(count_ - 1);
    std::ranges::nth_element(draws_, last, {}, &Draw::key);
    draws_.erase(last + 1, draws_.end());
    latest_ = draws_.back().key;
  }

  size_t count_;
  std::vector<Draw> draws_;
  uint64_t latest_ = std::numeric_limits<uint64_t>::max();  // later times are no longer among the samples
};

}  // namespace velour
