// Incident light of one hit: the terms of an ObservedHit.
#pragma once

#include <vector>

#include "render/lights/delta_light.h"
#include "render/paths_in_flight.h"

namespace velour {

/// Terms [0, middle) and [middle, end) are independent estimates (ObservedHit).
struct HitLight {
  std::vector<Vec3> wl;
  std::vector<Rgb> light;
  uint32_t middle = 0;
  float light_density = 0;
};

/// Records the terms of the renderer's estimator with their shadows. One per thread.
class HitLightRecorder {
 public:
  /// `options`: of two renders with independent random numbers, one for each half.
  HitLightRecorder(const Scene& scene, const Lighting& lighting, const RenderOptions (&options)[2])
      : visible_(scene),
        lighting_(lighting),
        options_(options),
        direct_{{scene, lighting, options[0], nullptr}, {scene, lighting, options[1], nullptr}},
        indirect_{{scene, lighting, options[0]}, {scene, lighting, options[1]}} {}

  /// Light that arrives at `vertex` over up to `bounces` surfaces. Random numbers are derived from `key`.
  HitLight record(const Vertex& vertex, int bounces, uint64_t key);

 private:
  void record_half(const Vertex& vertex, int bounces, uint64_t key, int half);
  /// Lights, environment and emissive meshes.
  void add_unoccluded_terms();
  /// Light that surfaces reflect.
  void add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half);
  void add_sharp(const Vertex& vertex, PathNumbers& numbers);
  /// To the sum of a direction; drops light that is not finite, as the renderer does.
  void add(uint32_t direction, const Vec3& wl, const Rgb& light);
  void add_term(const Vec3& wl, const Rgb& light);
  /// Records the luminance of light from lights, environment and emissive meshes with its density (Lighting::sample).
  void note_density(float density, const Rgb& light);
  float light_density();

  const VisibleRays visible_;
  const Lighting& lighting_;
  const RenderOptions (&options_)[2];
  DirectLight direct_[2];
  IndirectLight indirect_[2];
  HitLight result_;

  // For one half.
  IncidentLight incident_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<uint8_t> blocked_;
  std::vector<Rgb> passed_;  // transmittance of the rays
  std::vector<size_t> met_;  // paths that hit a surface
  Vec3 wl_[DirectionBatch::kCapacity];
  Rgb light_[DirectionBatch::kCapacity];  // by direction

  // For both halves.
  struct Concentration {
    float density;
    double luminance;
  };
  std::vector<Concentration> concentrations_;
  double irradiance_ = 0;  // luminance
};

}  // namespace velour
