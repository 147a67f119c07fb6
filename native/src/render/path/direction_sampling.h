// Directions sampled from the surface at a vertex, their density, and the rays that continue along them.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>
#include "brdf/eval/table_sampler.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/random.h"
#include "render/options.h"
#include "render/path/vertex.h"

namespace velour {

// Directions sampled from the surface at a vertex, and their density.

/// How directions are sampled from the surface.
enum class SurfaceSampling { uniform, cosine, table, ggx, material };

/// For `light`, which samples no direct light from the surface, this applies to the continuation ray: light reflected
/// by other surfaces comes from directions that light sampling would never choose.
SurfaceSampling surface_sampling(Strategy strategy);

/// The surface at a vertex, prepared for sampling directions; in the arena given, and as long as that is not reset.
class PreparedSurface {
 public:
  PreparedSurface() = default;
  PreparedSurface(SurfaceSampling sampling, const Vertex& vertex, const PrepareOptions& options, ScratchArena& arena);

  const PreparedBrdf& brdf() const { return *brdf_; }

  /// Local directions, one for each of up to 64 `u`; they may lie below the horizon. The batch is not padded.
  void sample(std::span<const Vec2> u, DirectionBatch& wl) const;

  /// Density per solid angle of sample() at each direction of `wl`. `brdf_pdf`: result of PreparedBrdf::eval.
  void pdf(const DirectionBatch& wl, const ScalarBatch& brdf_pdf, ScalarBatch& pdf) const;

 private:
  void sample_one_side(std::span<const Vec2> u, DirectionBatch& wl) const;
  void pdf_of_one_side(const DirectionBatch& wl, const ScalarBatch& brdf_pdf, ScalarBatch& pdf) const;
  /// Whether a density of one side serves both.
  bool shares_sides() const { return transmits_ && sampling_ != SurfaceSampling::material; }

  const PreparedBrdf* brdf_ = nullptr;
  SurfaceSampling sampling_ = SurfaceSampling::material;
  bool transmits_ = false;
  const GgxSampler* ggx_ = nullptr;
  GgxPoint ggx_point_;
  TablePoint table_;
};

// Combination of directions from several sampling techniques into one estimate.

/// Sampling technique of a direction.
enum class Technique : uint8_t { product = 0, surface = 1, lights = 2 };

/// Multiple importance sampling [VG95]: of n directions, the share c_k comes from density p_k; the shares sum to 1.
/// With q_k = c_k p_k, a direction contributes f / (n d):
///   balance  d = sum_k q_k               weight q_own / sum_k q_k
///   power    d = sum_k q_k^2 / q_own     weight q_own^2 / sum_k q_k^2, exponent 2
/// where "own" is the density that the direction was sampled from. A share of 0 leaves a density out. Returns d for
/// `q`, which is indexed by Technique.
inline float effective_density(Heuristic heuristic, const float (&q)[3], Technique own) {
  if (heuristic == Heuristic::balance) return q[0] + q[1] + q[2];
  const float q_own = q[static_cast<int>(own)];
  float d = 0.0f;
  // Quotients instead of squares: squared densities of narrow lobes and suns exceed float32. NaN densities stay NaN.
  for (const float other : q) d += other == 0.0f ? 0.0f : other * (other / q_own);
  return d;
}

/// Heuristic for lights and emissive meshes, whatever is chosen for the environment. Directions sampled toward an
/// unoccluded light have hardly any noise of their own; under the balance heuristic most of the noise came from the few
/// surface-sampled directions that hit it, up to 12 times the variance of the power heuristic
/// (docs/engine/strategies.md).
inline constexpr Heuristic kLampHeuristic = Heuristic::power;

/// Share of the products in the directions of `product` where the environment gives all light; other lights reduce it.
/// Six of eight directions; the rest guards against light and shadow that the lobes do not represent.
inline constexpr float kProductShare = 0.75f;

/// How a vertex mixes sampling techniques.
struct Mixing {
  bool products = false;     // up to kProductShare of the directions from products
  float light_share = 0.5f;  // share of the lights in the rest; the others come from the surface
};

inline Mixing mixing_of(const RenderOptions& options) {
  const float unmixed = options.strategy == Strategy::light ? 1.0f : 0.0f;
  return {options.strategy == Strategy::product, is_mixed(options.strategy) ? options.light_share : unmixed};
}

/// Shares of the sampling techniques at a vertex.
struct Shares {
  float product = 0, surface = 0, lights = 0;
};

/// Shares where a share `product` of the directions comes from products and `instead` from the lights in their place
/// (both 0 without products).
inline Shares shares(const Mixing& mixing, float product = 0, float instead = 0) {
  const float rest = 1.0f - product - instead;
  return {product, rest * (1.0f - mixing.light_share), rest * mixing.light_share + instead};
}

// Continuation rays of paths.

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
