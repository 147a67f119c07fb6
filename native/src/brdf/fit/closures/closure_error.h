// Accuracy and energy of closures.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closures.h"

namespace velour {

/// Relative L2 errors of f cos at a view; those of an anisotropic source are over all its azimuths.
struct ClosureViewError {
  int degrees;  // theta_v
  double luminance, rgb;
  double root;  // of the roots of all channels: errors around highlights count, too
};

/// The source at views of kHeldOutViews, over 1024 lights that resolve its highlights.
class ClosureJudge {
 public:
  ClosureJudge(const ClosureSource& source, const HighlightWidths& widths, int threads, const Progress& progress);
  std::vector<ClosureViewError> errors(const ClosureNetwork& network, LobeMasking masking) const;
  /// Errors of the mean over the azimuths, which no closures of this kind can go below. 0 for an isotropic source.
  std::vector<ClosureViewError> errors_of_mean() const;

 private:
  std::vector<std::vector<ClosureTarget>> views_;  // an element per azimuth of each view
};

/// Mean luminance error of the views up to 75 degrees.
double mean_closure_error(const std::vector<ClosureViewError>& errors);
/// Mean of the luminance and root errors of those views: what pictures show, since lights that a highlight misses are
/// reflected by its surroundings.
double visible_closure_error(const std::vector<ClosureViewError>& errors);

/// Albedo of the source at the samples of ClosureCurve and halfway between them, at most 89.5 degrees.
class ClosureAlbedo {
 public:
  ClosureAlbedo(const ClosureSource& source, const HighlightWidths& widths, int threads, const Progress& progress);

  /// Scales the weights of each sample of the curves so that the albedo is within 1 % of the source's, and never more
  /// than 1 % above it between the samples either. Channels that reflect less than a hundredth of the largest albedo
  /// are only reduced.
  void correct(ClosureNetwork& network, LobeMasking masking) const;
  /// Largest share by which the albedo of a channel exceeds the source's; not negative. 0 for a black source.
  double largest_excess(const ClosureNetwork& network, LobeMasking masking) const;

 private:
  Vec3d albedo_of(const ClosureNetwork& network, LobeMasking masking, const ClosureTarget& view) const;

  std::vector<ClosureTarget> views_;
  double largest_ = 0;
};

}  // namespace velour
