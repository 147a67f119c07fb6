// Interpolates isotropic BRDF samples at irregular directions.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"

namespace velour {

/// Local linear regression over the nearest samples of what a trend leaves, as regression kriging does [HHR07]: samples
/// a few degrees apart do not resolve a sharp highlight, but those of all views tell its shape. The trend is a
/// MicrofacetTrend of the samples, or none if leaving out each sample shows that regression alone predicts it as well.
/// f is assumed isotropic, reciprocal and mirror-symmetric, so a pair is a point (theta_h^0.7, theta_d,
/// 0.3 sin theta_h sin theta_d cos 2 phi_d). f varies fastest with theta_h, whose power spreads a highlight over
/// several samples. Each channel is compressed to asinh(f / 0.01 sr^-1), nearly logarithmic for highlights and linear
/// about 0; the regression has Gaussian weights over the 16 nearest samples and a light ridge on the slopes. What it
/// adds to a trend stays between what that leaves of those samples. Without a trend, the result never falls below those
/// samples; it may rise above them by their range, because a highlight's top mostly lies between samples.
class IrregularInterpolant {
 public:
  /// Copies what it needs. Throws Error(invalid_argument) for fewer than kNeighbors samples.
  explicit IrregularInterpolant(std::span<const IrregularSample> samples);
  ~IrregularInterpolant();
  IrregularInterpolant(const IrregularInterpolant&) = delete;
  IrregularInterpolant& operator=(const IrregularInterpolant&) = delete;

  /// Nothing if no sample is within kReach, or kReachOfTrend if there is a trend. Both directions must be above the
  /// horizon. Thread-safe.
  std::optional<Rgb> f(const Vec3& wl, const Vec3& wv) const;

  static constexpr int kNeighbors = 16;
  /// Distance in (theta_h, theta_d, sin theta_h sin theta_d |cos phi_d|), radians: the gaps of Cornell's sets are below
  /// 8 degrees.
  static constexpr double kReach = 10.0 * kPiD / 180.0;
  /// A trend that predicts samples from the others also tells highlights that no sample shows, as they are the same at
  /// all theta_d but for the Fresnel effect. Without them, models are black there.
  static constexpr double kReachOfTrend = 30.0 * kPiD / 180.0;

 private:
  struct Index;
  std::unique_ptr<const Index> index_;
};

/// The samples without spikes: those more than eight times as bright as all but two of their 16 neighbors, if the
/// neighbors surround them. A highlight between samples is no spike, because it has no dark samples at smaller theta_h,
/// nor is a peak at one end of theta_d. All samples if more than one in thirty were one, as of brushed metals, which
/// differ with azimuth.
std::vector<IrregularSample> without_spikes(std::vector<IrregularSample> samples);

/// Whether the samples leave the width of the highlights open: for most difference angles theta_d at which f is much
/// larger near theta_h = 0 than elsewhere, f is below a tenth of that at every other theta_h. Returns the mean angle
/// from the brightest sample to the next theta_h, radians; 0 if highlights are resolved, or there are none.
double gap_of_unresolved_highlights(std::span<const IrregularSample> samples);

/// The interpolant at the nodes of `layout` (phi_h 1, phi_d even), so that a look-up costs as little as MERL's.
std::vector<TableNode> resample_irregular(const IrregularInterpolant& interpolant, const BrdfTableLayout& layout,
                                          const Progress& progress);

}  // namespace velour
