// The relief of a captured BTF, and random points of it.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>
#include "btf/fit/side_views.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/measure/btf_measurement.h"
#include "btf/measure/relief.h"
#include "btf/model/factored_btf.h"
#include "math/srbf/multivariate_lobes.h"

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

// Random points of a relief with their values in all views, by which lobes are chosen and refined.

struct SurfacePoint {
  Vec2 place;      // in tiles
  Mat3 to_normal;  // from the tile's frame to that of the relief's normal
  std::vector<LobeArguments> pair;
  std::array<std::vector<float>, 3> value;  // per pair, along the color axes
};

/// Where a view's image shows the relief point at `place` and `height`: a position on the reference plane, in tiles.
/// Empty if the ray there ends more than three quarters of a texel from the point. `aspect`: tile_aspect().
std::optional<Vec2> shown_at(const Relief& relief, const Vec2& place, float height, float aspect, const Vec3& wv);

struct SurfacePointOptions {
  uint32_t points = 0;
  uint32_t pairs = 0;  // per point that every view sees, approximately
  uint64_t seed = 0;
};

/// Reads every view once. Visibility: shown_at().
std::vector<SurfacePoint> surface_points(CompandedViews& views, const TexelGrid& grid, const SideDirections& side,
                                         const Relief& relief, const SurfacePointOptions& options, Progress& progress);

// Partition of loops over texels for threads.

/// Texels per piece of work. Fixed, so that sums do not depend on the number of threads.
inline constexpr size_t kTexelsPerPiece = 64;

}  // namespace velour
