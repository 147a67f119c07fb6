#include "capture/goniometer/goniometer.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/parallel.h"
#include "capture/goniometer/height_field.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

constexpr int kMaxBounces = 256;
constexpr float kRouletteBelow = 0.1f;  // weight below which paths face Russian roulette
constexpr uint64_t kSamplesPerCheck = 2048;

/// Streams of random numbers, so that surfaces, patches and rays never share one.
enum class Stream : uint64_t { heights = 0, patches = 1, rays = 2 };
uint64_t stream_of(uint64_t tile, Stream stream) { return 3 * tile + static_cast<uint64_t>(stream); }

/// Exceeds the number of tiles: the body below tile i uses the streams of tile i + kTilesAbove.
constexpr uint64_t kTilesAbove = uint64_t{1} << 40;

double guide_over_cosine(const HeightFieldOptions& surface, const Vec3& w) {
  const double sin_x = w.x, sin_y = static_cast<double>(w.y) / surface.anisotropy;
  const double alpha_sin = surface.roughness * std::sqrt(sin_x * sin_x + sin_y * sin_y);
  return 1.0 / (static_cast<double>(w.z) + alpha_sin / (2.0 * std::sqrt(kPiD)));
}

/// A path on its way from the viewer to the light.
struct Path {
  Vec3 wv;        // view direction at its start
  Vec3 arriving;  // unit, from the current point back along the path
  FacetPoint at;
  bool met_base;  // or a body
  Rgb weight;     // flux towards the light per unit of flux that arrives along wv
};

/// Traces one tile into one batch.
class TileRun {
 public:
  TileRun(const GoniometerOptions& options, const GoniometerBins& bins, uint64_t tile, GoniometerSums& sums)
      : options_(options),
        bins_(bins),
        tile_(make_height_field(options.surface, options.seed, stream_of(tile, Stream::heights)),
              patches(options, tile)),
        stream_(stream_of(tile, Stream::rays)),
        sums_(sums) {
    if (options.body) below_.emplace(*options.body, options.seed, stream_of(tile + kTilesAbove, Stream::heights));
  }

  void count_facets() {
    for (int facet = 0; facet < tile_.facets(); ++facet) {
      if (!tile_.is_base(facet)) bins_.slopes.deposit(tile_.slope(facet), sums_.metal_facets);
    }
    sums_.facets += tile_.facets();
  }

  void sample(uint64_t index) {
    RandomStream random(options_.seed, stream_, index);
    sums_.samples += 1.0;
    const FacetPoint start = tile_.point_above(random.next2());
    const Vec2 u = random.next2();
    const Vec3 wv = direction(0.5f * kPi * u.x, 2.0f * kPi * u.y);
    const float cosine = glm::dot(start.normal, wv);
    if (cosine <= 0.0f || wv.z <= 0.0f) return;
    const bool seen = count_ray(tile_.escapes(start.position, wv));
    if (!seen) {
      if (!start.base) count_mirror_pair({mirrored(wv, start.normal), wv}, false);
      return;
    }
    // Facet area seen from wv, per area of the mean plane seen from wv.
    const float weight = cosine / (start.normal.z * wv.z);
    const Path path{wv, wv, start, false, Rgb(weight)};
    if (start.base) {
      follow_scattered(path, random);
    } else {
      if (below_) follow_through_body(path, random);
      follow_mirrored(path, random);
    }
  }

 private:
  static std::vector<uint8_t> patches(const GoniometerOptions& options, uint64_t tile) {
    if (options.base_share <= 0.0) return {};
    // Patches four correlations wide: most facets have neighbors of their own kind.
    return make_patches(options.surface.cells, 4.0 * options.surface.correlation, options.base_share, options.seed,
                        stream_of(tile, Stream::patches));
  }

  static Vec3 mirrored(const Vec3& w, const Vec3& normal) { return 2.0f * glm::dot(w, normal) * normal - w; }

  bool count_ray(bool result) {
    ++sums_.rays;
    return result;
  }

  /// Calls `count` with the pair and, by reciprocity, with its ends exchanged.
  template <class Count>
  void both_ways(const DirectionPair& pair, const Count& count) const {
    count(pair);
    if (options_.reciprocal) count(DirectionPair{pair.wv, pair.wl});
  }

  void count_mirror_pair(const DirectionPair& pair, bool clear) {
    if (pair.wl.z <= 0.0f) return;
    const double cosines = static_cast<double>(pair.wl.z) * static_cast<double>(pair.wv.z);
    const double guide = cosines * mirror_guide_over_cosines(options_.surface, pair);
    both_ways(pair, [&](const DirectionPair& p) {
      const PairGrid::Stencil stencil = bins_.mirror.stencil(p);
      deposit(stencil, guide, sums_.tried);
      if (clear) deposit(stencil, 1.0, sums_.clear);
    });
  }

  void collect(const DirectionPair& pair, const Path& path) {
    const PairGrid& grid = path.met_base ? bins_.diffuse : bins_.metal;
    std::vector<double>& flux = path.met_base ? sums_.diffuse_flux : sums_.metal_flux;
    both_ways(pair, [&](const DirectionPair& p) {
      const PairGrid::Stencil stencil = grid.stencil(p);
      for (int i = 0; i < stencil.count; ++i) {
        const auto at = static_cast<size_t>(i);
        const Rgb value = stencil.share[at] * path.weight;
        for (int c = 0; c < 3; ++c) {
          flux[3 * size_t{stencil.node[at]} + static_cast<size_t>(c)] += static_cast<double>(value[c]);
        }
      }
    });
  }

  Rgb reflectance(const Path& path) const { return options_.facets.at(glm::dot(path.arriving, path.at.normal)); }

  /// Direction in which the path continues, chosen at random at an interface; multiplies its weight.
  Vec3 scatter(Path& path, RandomStream& random) const {
    const Vec3& normal = path.at.normal;
    if (path.at.base) {
      path.met_base = true;
      path.weight *= options_.base_albedo;
      return Frame::about(normal).to_world(sample_cosine_hemisphere(random.next2()));
    }
    if (!below_) {
      path.weight *= reflectance(path);
    } else if (random.next() >= reflectance(path).r) {
      return scatter_in_body(path, random);
    }
    return mirrored(path.arriving, normal);
  }

  Vec3 scatter_in_body(Path& path, RandomStream& random) const {
    const Frame frame = Frame::about(path.at.normal);
    path.met_base = true;
    return frame.to_world(below_->through(frame.to_local(path.arriving), path.weight, random));
  }

  static bool survives(Path& path, RandomStream& random) {
    const float brightest = std::max({path.weight.r, path.weight.g, path.weight.b});
    if (brightest >= kRouletteBelow) return true;
    if (random.next() * kRouletteBelow >= brightest) return false;
    path.weight *= kRouletteBelow / brightest;
    return true;
  }

  void follow_mirrored(Path path, RandomStream& random) {
    path.weight *= reflectance(path);
    const Vec3 leaving = mirrored(path.arriving, path.at.normal);
    const Fate fate = advance(path, leaving);
    count_mirror_pair({leaving, path.wv}, fate == Fate::escaped);
    if (fate == Fate::hit) follow_scattered(path, random);
  }

  void follow_through_body(Path path, RandomStream& random) {
    path.weight *= 1.0f - reflectance(path);
    const Vec3 leaving = scatter_in_body(path, random);
    follow(path, leaving, random);
  }

  void follow_scattered(Path path, RandomStream& random) {
    const Vec3 leaving = scatter(path, random);
    follow(path, leaving, random);
  }

  /// Advances the path to the next facet, if there is one.
  Fate advance(Path& path, const Vec3& leaving) {
    ++sums_.rays;
    const Fate fate = tile_.trace(path.at.position, leaving, path.at);
    path.arriving = -leaving;
    if (fate == Fate::lost) ++sums_.lost;
    return fate;
  }

  /// Follows the path from direction `leaving` until it escapes and is collected.
  void follow(Path path, Vec3 leaving, RandomStream& random) {
    for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
      if (!survives(path, random)) return;
      const Fate fate = advance(path, leaving);
      if (fate == Fate::escaped) collect({leaving, path.wv}, path);
      if (fate != Fate::hit) return;
      leaving = scatter(path, random);
    }
    ++sums_.lost;
  }

  const GoniometerOptions& options_;
  const GoniometerBins& bins_;
  PeriodicTile tile_;
  std::optional<BodyBelow> below_;
  uint64_t stream_;
  GoniometerSums& sums_;
};

}  // namespace

double mirror_guide_over_cosines(const HeightFieldOptions& surface, const DirectionPair& pair) {
  return guide_over_cosine(surface, pair.wl) * guide_over_cosine(surface, pair.wv);
}

std::vector<GoniometerSums> run_goniometer(const GoniometerOptions& options, Progress& progress) {
  const GoniometerBins bins(options);
  std::vector<GoniometerSums> batches(static_cast<size_t>(options.batches), GoniometerSums(bins));
  const auto tiles = static_cast<uint64_t>(options.tiles_per_batch);
  std::atomic<uint64_t> done{0};
  const double all = static_cast<double>(options.samples_per_tile * tiles) * options.batches;
  const auto run_tile = [&](uint64_t tile, GoniometerSums& sums) {
    progress.check();
    TileRun run(options, bins, tile, sums);
    progress.check();
    run.count_facets();
    for (uint64_t i = 0; i < options.samples_per_tile; ++i) {
      if (i % kSamplesPerCheck == 0) {
        progress.check();
        progress.update(static_cast<double>(done += i == 0 ? 0 : kSamplesPerCheck) / all);
      }
      run.sample(i);
    }
  };
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, batches.size(), [&](size_t b) {
      for (uint64_t t = 0; t < tiles; ++t) run_tile(b * tiles + t, batches[b]);
    });
  });
  return batches;
}

namespace {

/// Minimum number of pairs in a bin; below it, the next coarser bin is used.
constexpr double kEnoughPairs = 16;

}  // namespace

MicrosurfaceBrdf::BinnedBrdf::BinnedBrdf(const PairGrid& grid, std::vector<double> flux, double samples,
                                         bool reciprocal) {
  std::vector<double> measure = grid.flux_measure(false);
  if (reciprocal) {
    const std::vector<double> exchanged = grid.flux_measure(true);
    std::transform(measure.begin(), measure.end(), exchanged.begin(), measure.begin(), std::plus<>());
  }
  grid.pool_by_symmetry(flux, 3);
  grid.pool_by_symmetry(measure, 1);
  for (size_t c = 0; c < 3; ++c) {
    f[c].resize(grid.size());
    for (size_t i = 0; i < grid.size(); ++i) f[c][i] = flux[3 * i + c] / (samples * measure[i]);
  }
}

Rgb MicrosurfaceBrdf::BinnedBrdf::at(const PairGrid::Stencil& stencil) const {
  return {look_up(stencil, f[0]), look_up(stencil, f[1]), look_up(stencil, f[2])};
}

MicrosurfaceBrdf::MicrosurfaceBrdf(const GoniometerOptions& options, const GoniometerBins& bins,
                                   const GoniometerSums& sums)
    : options_(options),
      bins_(bins),
      slope_density_(bins.slopes.density(sums.metal_facets, sums.facets)),
      tried_(sums.tried),
      clear_(sums.clear),
      metal_(bins.metal, sums.metal_flux, sums.samples, options.reciprocal),
      diffuse_(bins.diffuse, sums.diffuse_flux, sums.samples, options.reciprocal) {
  const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  clear_share_overall_ = sum(clear_) / sum(tried_);
  bins_.mirror.pool_by_symmetry(tried_, 1);
  bins_.mirror.pool_by_symmetry(clear_, 1);
  tried_coarse_ = tried_;
  clear_coarse_ = clear_;
  bins_.mirror.pool_azimuths(tried_coarse_);
  bins_.mirror.pool_azimuths(clear_coarse_);
}

double MicrosurfaceBrdf::clear_share(const PairGrid::Stencil& stencil) const {
  const double tried = look_up(stencil, tried_);
  if (tried >= kEnoughPairs) return look_up(stencil, clear_) / tried;
  const double tried_coarse = look_up(stencil, tried_coarse_);
  if (tried_coarse >= kEnoughPairs) return look_up(stencil, clear_coarse_) / tried_coarse;
  return clear_share_overall_;
}

Rgb MicrosurfaceBrdf::single(const DirectionPair& pair) const {
  const Vec3 h = glm::normalize(pair.wl + pair.wv);
  const double density = bins_.slopes.look_up({-h.x / h.z, -h.y / h.z}, slope_density_);
  if (density == 0.0) return Rgb(0);
  // Slopes to normals: d(slope) = d omega_h / cos^3; area of the mean plane to that of facets: another 1 / cos.
  const double h_z_sq = static_cast<double>(h.z) * static_cast<double>(h.z);
  const double facets = density / (h_z_sq * h_z_sq);
  const double visible = clear_share(bins_.mirror.stencil(pair)) * mirror_guide_over_cosines(options_.surface, pair);
  return static_cast<float>(0.25 * facets * visible) * options_.facets.at(glm::dot(pair.wv, h));
}

Rgb albedo(const MicrosurfaceBrdf& brdf, Rgb (MicrosurfaceBrdf::*part)(const DirectionPair&) const, const Vec3& wv,
           int lights) {
  Vec3d sum(0);
  for (const Vec3& wl : hemisphere_fibonacci(lights)) {
    const Rgb f = (brdf.*part)({wl, wv});
    sum += Vec3d(f) * static_cast<double>(wl.z);
  }
  return Rgb(2.0 * kPiD / lights * sum);
}

}  // namespace velour
