// The relief of a captured BTF.
#pragma once

#include <cmath>
#include <vector>
#include "btf/fit/side_views.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/measure/btf_measurement.h"
#include "btf/measure/relief.h"
#include "btf/model/factored_btf.h"

namespace velour {

/// The relief of every level, finest first, with heights rounded to half floats: first hits of the view nearest to the
/// normal, averaged over texels; the lowest point of the shell where it hits nothing. Flat, on the reference plane, for
/// a BTF without structure.
std::vector<Relief> relief_pyramid(const BtfMeasurement& measurement, const SideDirections& side);
/// The reference plane, with the same levels.
std::vector<Relief> plane_pyramid(const TexelGrid& grid);

std::vector<HalfBits> stored_heights(const Relief& relief);

// Error of images reconstructed over a relief, whatever the texels' model.

/// Reconstructs images from the values of the relief's texels in them (shown_texels): where a view ray hits the relief,
/// from those of the four texels there that the view shows. The difference from the images is lost by interpolating
/// twice between texels, and near edges, where some of the four are hidden. Pixels whose four texels are all hidden do
/// not count.
class ReliefGap {
 public:
  /// Uses `pixels` random pixels of each view.
  ReliefGap(const TensorSource& source, size_t pixels, const Progress& progress);

  /// Call once per view, with its finest level.
  void add_view(Index view, const LevelImages& images);
  /// Squares of the difference relative to those of the images; 0 on the plane.
  double share() const;

 private:
  struct Squares {
    double difference = 0, image = 0;
  };
  const TensorSource& source_;
  const Progress& progress_;
  std::vector<uint32_t> pixel_;
  std::vector<Squares> squares_;  // per pixel
};

// Brightness correction of fitted models.

/// Factor for a level's coefficients that restores the measured brightness. A least-squares fit of roots leaves out
/// their spread around the fit; f is their square, so its mean falls by the mean square of the residual, and the
/// material would be darker than measured. `measured`: the sum of squares of a level's roots over texels, channels and
/// pairs, each times cos(theta_l) cos(theta_v); `modelled`: the same of their fit. The factor preserves the light that
/// leaves the plane under uniform illumination.
inline float brightening(Companding companding, double measured, double modelled) {
  if (companding == Companding::none || !(modelled > 0)) return 1.0f;
  return static_cast<float>(std::sqrt(measured / modelled));
}

}  // namespace velour
