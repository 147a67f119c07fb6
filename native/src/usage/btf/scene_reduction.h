// A BTF's model, reduced to its scene usage: as small as the images allow.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>
#include "btf/fit/btf_compare.h"
#include "btf/fit/btf_fit.h"
#include "btf/measure/btf_measurement.h"
#include "btf/measure/pair_layout.h"
#include "model/model.h"
#include "usage/observation.h"

namespace velour {

// Image error of a model relative to its BTF, under the scene usage.

/// Images of the whole tile, one per hit, with its view and light; for the first kPictures hits that have light (hits
/// come in random order). Each hit has two images, one for either half of its terms: the expected product of a model's
/// errors in both is the square of its error under all of the light, however few terms represent it.
///
/// The truth is the BTF, interpolated between its views and lights. Directions lie between those to which a model was
/// fitted, so a model that follows only those is detected.
class SeenPictures {
 public:
  /// `truth`: the BTF at the resolution of the scene (scene_btf.h); must outlive this object. A pixel is 2 x 2 of its
  /// texels (kTexelsOfLookUp).
  SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress);

  bool empty() const { return pictures_.empty(); }
  /// relmse of the images of a BTF's model: mean over hits, pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2), where
  /// b is the truth and m the mean of its image; at least 0. A model with more texels is averaged to the same pixels.
  double error(const ModelBody& body, const Progress& progress) const;

  static constexpr size_t kPictures = 16;

 private:
  struct Light {
    Vec3 wl;
    float amount;  // luminance
  };
  struct Half {
    std::vector<Light> light;
    std::vector<float> radiance;  // [pixel][channel], of the truth
  };
  struct Picture {
    Vec3 wv;
    std::array<Half, 2> half;
  };
  /// Uses only light that the truth covers. `mirrored`: seen from below, so light above the horizon comes from below,
  /// too.
  Half half_of_hit(const ObservedHit& hit, bool second, const SceneObservation& observation, bool mirrored) const;
  std::vector<float> true_radiance(const Vec3& wv, const Half& half, const Progress& progress) const;
  std::vector<float> picture_of(const BtfImages& images, const TexelGrid& grid, const Vec3& wv, const Half& half,
                                const Progress& progress) const;

  const BtfMeasurement& truth_;
  const PairInterpolation between_;
  std::vector<Picture> pictures_;
};

// Refit of a BTF's model to its scene usage, as small as the images allow.

struct SceneRefit {
  ModelBody body;                    // its layout has the views to which it was fitted
  double error = 0, full_error = 0;  // SeenPictures::error
};

/// `levels` is `full` without the levels that the scenes do not resolve (scene_btf.h). Fits the BTF at the
/// resolution of `levels`, reduced to the views seen and those around them (scene_btf.h). Takes the smallest size tried
/// by least_size(), between a 64th of the bytes of `full` and those of `levels`, whose image error is within
/// kMoreError of that of `full`; if there is none, the largest size, if its error is below that of `levels`. Otherwise
/// returns nothing; also if the observation has no light or the BTF has entries that are not finite, and for clustered
/// tensors, which only lose levels.
std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress);

/// Maximum ratio of the relmse to that of the full model.
inline constexpr double kMoreError = 1.1;

/// Reduces options.full_model, or the model that the other options ask for, to a smaller one of the same method:
/// refitted to the scene usage options.for_scene (refit_for_scene) or, if that is no better, without the levels that no
/// ray resolves (scene_btf.h). The result carries a SceneRecord; usage/observation.h reports a camera that comes
/// closer or sees other views. If the scene needs every level, returns the full model with a warning. `psnr`, `ser` and
/// speed are those of the full model.
///
/// Throws Error(invalid_argument) if nothing of a surface was observed, or if the full model is not one of this BTF or
/// is itself reduced.
Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

// Search for the smallest sufficient size with few trials.

/// Sizes are numbered from 0. Doubles the size from the smallest until one is good, then searches between it and the
/// previous one, to within a fifth. The candidate sizes do not depend on `good`, and larger sizes are not assumed to be
/// better: a search that accepts every size that another one accepts never returns a larger size.
///
/// `good`: whether a size is sufficient. Returns a good size, or `end` if none is found below it.
size_t least_size(size_t end, const std::function<bool(size_t)>& good);

}  // namespace velour
