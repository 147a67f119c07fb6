// The environment as a non-negative mixture of Gaussian SRBFs: the light side of product sampling [T08].
#pragma once

#include <string>
#include <vector>

#include "job/progress.h"
#include "sphere/vec.h"

namespace velour {

class Environment;
class EquirectangularImage;

/// Radiance(w) ~ sum_k coefficient_k exp(bandwidth_k (w . center_k - 1)). Steers sampling; no picture is made of it.
struct SkyMixture {
  std::vector<Vec3> center;  // unit; world frame, or the image's where stated
  std::vector<float> bandwidth;
  std::vector<Rgb> coefficient;  // radiance, never negative
  /// Relative L2 error of luminance over the sphere, image and mixture both smoothed by a Gaussian SRBF of bandwidth
  /// kSmoothing (a deviation of four degrees).
  float relative_l2 = 0;
  double seconds = 0;  // that the fit, or reading it, took
  bool cached = false;

  static constexpr double kSmoothing = 200;
  size_t size() const { return center.size(); }
};

struct SkyFitOptions {
  double tolerance = 0.02;  // of relative_l2: the order grows until it is met
  int max_lobes = 256;
};

/// Fits `image`, centres in its frame. Deterministic for any number of threads (those of the calling arena). A black
/// image has no lobes. Throws Error(cancelled).
///
/// The order doubles in rounds: where the image exceeds the mixture, each of the worst lobes (by chi-square divergence)
/// gives birth to a lobe with the moments of that excess; expectation maximisation of von Mises-Fisher densities on
/// luminance then moves all [BDGS05]. Colours are the energy that each lobe accounts for, so the sum of all energy, per
/// channel, is exact, and a sun of a few texels is a lobe of its own.
SkyMixture fit_sky(const EquirectangularImage& image, const SkyFitOptions& options, const Progress& progress);

/// Of an environment, in the world frame; one lobe of bandwidth 0 for a constant one, none for a black one. With a
/// `cache_folder` (created when missing) fits are kept by the image's content; a file there that is not what it should
/// be is replaced, and a folder that cannot be written costs only the speed.
SkyMixture sky_mixture(const Environment& environment, const SkyFitOptions& options, const std::string& cache_folder,
                       const Progress& progress);

}  // namespace velour
