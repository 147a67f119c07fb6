#include "capture/goniometer/microsurface_brdf.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "math/sphere/directions.h"

namespace velour {

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
