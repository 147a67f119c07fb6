// The environment as a non-negative mixture of Gaussian SRBFs: the light side of product sampling [T08].
#pragma once

#include <string>
#include <vector>
#include "base/progress.h"
#include "math/sphere/vec.h"

namespace velour {

class Environment;
class EquirectangularImage;

/// Radiance(w) ~ sum_k coefficient_k exp(bandwidth_k (w . center_k - 1)). Used for sampling only, never for shading.
struct EnvironmentMixture {
  std::vector<Vec3> center;  // unit; world frame unless stated otherwise
  std::vector<float> bandwidth;
  std::vector<Rgb> coefficient;  // radiance, never negative
  /// Relative L2 error of luminance over the sphere, with image and mixture both smoothed by a Gaussian SRBF of
  /// bandwidth kSmoothing (a standard deviation of four degrees).
  float relative_l2 = 0;
  double seconds = 0;  // time for fitting the mixture or reading it from the cache
  bool cached = false;

  static constexpr double kSmoothing = 200;
  size_t size() const { return center.size(); }
};

struct EnvironmentFitOptions {
  double tolerance = 0.02;  // maximum relative_l2; lobes are added until it is met
  int max_lobes = 256;
};

/// Fits `image`, with centers in its frame. Deterministic for any number of threads (those of the calling arena). A
/// black image has no lobes. Throws Error(cancelled).
///
/// The number of lobes grows by half per round: where the image exceeds the mixture, each of the worst lobes (by
/// chi-square divergence) spawns a lobe with the moments of that excess; expectation maximization of von Mises-Fisher
/// densities on luminance then moves all of them [BDGS05]. A lobe's color is the energy that it accounts for, so the
/// total energy is exact per channel, and a sun of a few texels gets a lobe of its own.
EnvironmentMixture fit_environment(const EquirectangularImage& image, const EnvironmentFitOptions& options,
                                   const Progress& progress);

/// Mixture of an environment in the world frame: one lobe of bandwidth 0 for a constant one, none for a black one. With
/// a `cache_folder` (created if missing), fits are cached by the image's content. Invalid files there are replaced; a
/// folder that cannot be written only costs time.
EnvironmentMixture mixture_of_environment(const Environment& environment, const EnvironmentFitOptions& options,
                                          const std::string& cache_folder, const Progress& progress);

// Misfit of a mixture of lobes as a sampling density of its environment.

/// Chi-square of the environment's own density p (Environment::sample) against the density q of the mixture's
/// luminance,
///   int p^2 / q dw - 1,
/// from 1024 evenly spread samples of p: the variance over the squared mean of the light on a receiver that weights all
/// directions equally, when directions are sampled from q. 0 if both agree, 0.1 to 0.3 if lights have sharp edges,
/// which Gaussians cannot represent; infinite if the mixture misses a light. Neither may be black. Deterministic.
double misfit_of_environment(const Environment& environment, const EnvironmentMixture& sky);

}  // namespace velour
