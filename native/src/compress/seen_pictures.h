// How wrong pictures are with a model in place of its BTF, as scenes showed the material.
#pragma once

#include <vector>

#include "btf/btf_measurement.h"
#include "domain/observation.h"
#include "model/model.h"

namespace velour {

/// Pictures of the whole tile, one a hit: seen as the hit was, under its light, in kDirections of its terms in
/// proportion to their luminance. The first kPictures hits that tell their light (hits come in random order).
///
/// The truth is the BTF, interpolated between its views and lights: directions lie between those that a model was
/// fitted to, so that a model that follows them alone is found out.
class SeenPictures {
 public:
  /// `truth`: a BTF at the resolution of the scene (scene_btf.h). A pixel is 2 x 2 of its texels (kTexelsOfLookUp).
  SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress);

  bool empty() const { return pictures_.empty(); }
  /// relmse of the pictures of a BTF's model: mean over hits, pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2), b
  /// the truth, m the mean of its picture. A model with more texels is averaged to pixels as well.
  double error(const ModelBody& body, const Progress& progress) const;

  static constexpr size_t kPictures = 12, kDirections = 96;

 private:
  struct Picture {
    Vec3 wv;
    std::vector<Vec3> wl;         // each counts the same
    std::vector<float> radiance;  // [pixel][channel], of the truth
  };

  const uint32_t width_;  // of `truth`, texels
  std::vector<Picture> pictures_;
};

}  // namespace velour
