// How wrong pictures are with a model in place of its BTF, as scenes showed the material.
#pragma once

#include <array>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/pair_interpolation.h"
#include "compress/btf_compare.h"
#include "domain/observation.h"
#include "model/model.h"

namespace velour {

/// Pictures of the whole tile, one a hit: seen as the hit was, under its light. The first kPictures hits that tell
/// their light (hits come in random order). Each has two, under either half of the hit's terms: the product of a
/// model's errors in both has the square of its error under all of the light as its expectation, however few terms
/// stand for that.
///
/// The truth is the BTF, interpolated between its views and lights: directions lie between those that a model was
/// fitted to, so that a model that follows them alone is found out.
class SeenPictures {
 public:
  /// `truth`: a BTF at the resolution of the scene (scene_btf.h); it must outlive this. A pixel is 2 x 2 of its texels
  /// (kTexelsOfLookUp).
  SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress);

  bool empty() const { return pictures_.empty(); }
  /// relmse of the pictures of a BTF's model: mean over hits, pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2), b
  /// the truth, m the mean of its picture; at least 0. A model with more texels is averaged to pixels as well.
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
  /// Of the light that the truth knows. `mirrored`: seen from below, so light above the horizon comes from below, too.
  Half half_of_hit(const ObservedHit& hit, bool second, const SceneObservation& observation, bool mirrored) const;
  std::vector<float> true_radiance(const Vec3& wv, const Half& half, const Progress& progress) const;
  std::vector<float> picture_of(const BtfImages& images, const TexelGrid& grid, const Vec3& wv, const Half& half,
                                const Progress& progress) const;

  const BtfMeasurement& truth_;
  const PairInterpolation between_;
  std::vector<Picture> pictures_;
};

}  // namespace velour
