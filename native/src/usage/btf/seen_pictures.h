// Image error of a model relative to its BTF, under the scene usage.
#pragma once

#include <array>
#include <vector>

#include "btf/fit/btf_compare.h"
#include "btf/measure/btf_measurement.h"
#include "btf/measure/pair_interpolation.h"
#include "model/model.h"
#include "usage/observation.h"

namespace velour {

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

}  // namespace velour
