// Light scattered by a rough surface, collected in bins, and the BRDF computed from it.
#pragma once

#include <vector>
#include "base/progress.h"
#include "capture/goniometer/bins.h"

namespace velour {

// Light traced over random surfaces, collected in bins.

/// The guide g(wl) g(wv) divided by wl.z wv.z, which is finite at the horizon. g(w) = cos / (cos + kappa sin), kappa =
/// alpha(phi) / (2 sqrt(pi)), falls towards the horizon as fast as the visibility of a Gaussian surface. Visibility is
/// collected as a ratio to the guide, so that bins may be wide where visibility falls steeply; the estimate converges
/// to the traced visibility for any guide.
double mirror_guide_over_cosines(const HeightFieldOptions& surface, const DirectionPair& pair);

/// Returns one element per batch, in order; the result does not depend on the number of threads.
///
/// A sample is a point of the surface, uniform over the mean plane, and a view of uniform theta_v and azimuth. If the
/// viewer sees the point, light is followed backwards from there: mirrored by metal, scattered with a cosine by the
/// base, until it escapes. The first mirror pair of a metal facet is counted in `tried` and `clear`; light that
/// escapes after any other history adds to `flux`. At the first facet of a clear surface, both the reflection and the
/// path through the body are followed; at later facets, one of them is chosen at random.
std::vector<GoniometerSums> run_goniometer(const GoniometerOptions& options, Progress& progress);

// The BRDF estimated by a goniometer run.

/// f of any pair of directions above the horizon, from the collected sums: single reflection off metal as F(theta_d) x
/// facets per solid angle x share of clear pairs / (4 cos theta_l cos theta_v), plus the flux bins. Reciprocal up to
/// rounding. Thread-safe.
class MicrosurfaceBrdf {
 public:
  /// `options` and `bins` must be those of the run.
  MicrosurfaceBrdf(const GoniometerOptions& options, const GoniometerBins& bins, const GoniometerSums& sums);

  /// 1/sr, linear Rec. 709, without cosine. Bins with too few rays are replaced by coarser ones.
  Rgb f(const DirectionPair& pair) const { return single(pair) + multiple(pair) + diffuse(pair); }
  /// Light that met the metal once and nothing else.
  Rgb single(const DirectionPair& pair) const;
  /// Light that met the metal several times and nothing else.
  Rgb multiple(const DirectionPair& pair) const { return metal_.at(bins_.metal.stencil(pair)); }
  /// Light that met the diffuse base.
  Rgb diffuse(const DirectionPair& pair) const { return diffuse_.at(bins_.diffuse.stencil(pair)); }

 private:
  /// f of every bin of a grid.
  struct BinnedBrdf {
    BinnedBrdf(const PairGrid& grid, std::vector<double> flux, double samples, bool reciprocal);
    Rgb at(const PairGrid::Stencil& stencil) const;
    std::vector<double> f[3];
  };
  double clear_share(const PairGrid::Stencil& stencil) const;

  GoniometerOptions options_;
  GoniometerBins bins_;
  std::vector<double> slope_density_;                // per slope bin
  std::vector<double> tried_, clear_;                // per mirror bin, pooled by symmetry
  std::vector<double> tried_coarse_, clear_coarse_;  // likewise, pooled over azimuths
  double clear_share_overall_;                       // over all pairs: the coarsest bin
  BinnedBrdf metal_, diffuse_;
};

/// Directional albedo at wv: integral of f cos(theta_l) over the light directions, estimated from `lights` directions
/// of equal solid angle. `part` selects f or one of its parts.
Rgb albedo(const MicrosurfaceBrdf& brdf, Rgb (MicrosurfaceBrdf::*part)(const DirectionPair&) const, const Vec3& wv,
           int lights);

}  // namespace velour
