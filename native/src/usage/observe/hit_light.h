// Incident light of one hit: the terms of an ObservedHit.
#pragma once

#include <span>
#include <vector>

#include "render/direction_sampling.h"
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

/// One per thread.
class HitLightEstimator {
 public:
  /// `options`: of two renders with independent random numbers, one for each half.
  HitLightEstimator(const Scene& scene, const Lighting& lighting, const RenderOptions (&options)[2])
      : scene_(scene),
        visible_(scene),
        lighting_(lighting),
        options_(options),
        indirect_{IndirectLight(scene, lighting, options[0]), IndirectLight(scene, lighting, options[1])} {}

  /// Light that arrives at `vertex` over up to `bounces` surfaces. Random numbers are derived from `key`.
  HitLight estimate(const Vertex& vertex, int bounces, uint64_t key);

 private:
  void estimate_half(const Vertex& vertex, int bounces, uint64_t key, int half);
  /// Numbers of directions sampled from the lights and from the surface.
  struct Counts {
    int lights, surface;
    int all() const { return lights + surface; }
  };
  Counts counts(int bounces) const;
  void draw(const Vertex& vertex, Counts counts, PathNumbers& numbers);
  void keep_if_received(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world, Technique technique,
                        const Hit& aim);
  void weigh(const Vertex& vertex, Counts counts);
  void trace(const Vertex& vertex);
  void add_lights(const Vertex& vertex);
  /// Transmittance of the way from a light.
  Rgb passed_from(const Vertex& vertex, const LampHit& lamp) const;
  void add_emissive(const Vertex& vertex, Counts counts);
  void add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half);
  void add_sharp(const Vertex& vertex, PathNumbers& numbers);
  void add_term(const Vec3& wl, const Rgb& light);
  /// Records the luminance of light from lights, environment and emissive meshes with its density (Lighting).
  void note_density(float density, const Rgb& light);
  float light_density();

  const Scene& scene_;
  const VisibleRays visible_;
  const Lighting& lighting_;
  const RenderOptions (&options_)[2];
  IndirectLight indirect_[2];
  ScratchArena arena_;
  const PreparedBrdf* brdf_ = nullptr;
  HitLight result_;

  // For one half: directions that the vertex receives light from.
  DirectionBatch local_, world_;
  RgbBatch environment_, f_;
  ScalarBatch light_pdf_, material_pdf_;
  std::vector<LampHit> lamp_hits_;
  Technique technique_[DirectionBatch::kCapacity];
  Hit aims_[DirectionBatch::kCapacity];      // from Lighting::sample
  float weight_[DirectionBatch::kCapacity];  // cos / (n density); 0: aimed at an emissive mesh
  Ray rays_[DirectionBatch::kCapacity];
  Hit hits_[DirectionBatch::kCapacity];
  Rgb passed_[DirectionBatch::kCapacity];  // transmittance of the ray
  Rgb radiance_[DirectionBatch::kCapacity];
  Rgb emissive_[DirectionBatch::kCapacity];  // light of emissive meshes, weighted
  LightView view_;
  uint8_t view_of_[DirectionBatch::kCapacity] = {};  // all refer to view_

  // For both halves.
  struct Concentration {
    float density;
    double luminance;
  };
  std::vector<Concentration> concentrations_;
  double irradiance_ = 0;  // luminance
};

}  // namespace velour
