// Where the light of one hit comes from: the terms of an ObservedHit.
#pragma once

#include <span>
#include <vector>

#include "render/combination.h"
#include "render/indirect_light.h"
#include "render/sharp_lamps.h"

namespace velour {

/// Terms [0, middle) and [middle, end) are independent estimates (ObservedHit).
struct HitLight {
  std::vector<Vec3> wl;
  std::vector<Rgb> light;
  uint32_t middle = 0;
  float light_density = 0;
};

/// One a thread.
class HitLightEstimator {
 public:
  /// `options`: those of two renders whose random numbers are independent, one a half.
  HitLightEstimator(const Scene& scene, const Lighting& lighting, const RenderOptions (&options)[2])
      : scene_(scene),
        visible_(scene),
        lighting_(lighting),
        options_(options),
        indirect_{IndirectLight(scene, lighting, options[0]), IndirectLight(scene, lighting, options[1])} {}

  /// What arrives at `vertex` over up to `bounces` surfaces. Random numbers come from `key`.
  HitLight estimate(const Vertex& vertex, int bounces, uint64_t key);

 private:
  void estimate_half(const Vertex& vertex, int bounces, uint64_t key, int half);
  /// How many directions there are, and which of them are drawn towards light.
  struct Counts {
    int lights, surface;
    int all() const { return lights + surface; }
  };
  Counts counts(int bounces) const;
  void draw(const Vertex& vertex, Counts counts, PathNumbers& numbers);
  void keep_if_received(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world, Drawer drawer, const Hit& aim);
  void weigh(const Vertex& vertex, Counts counts);
  void trace(const Vertex& vertex);
  void add_lights(const Vertex& vertex);
  /// What is left on the way of what a lamp sends.
  Rgb passed_from(const Vertex& vertex, const LampHit& lamp) const;
  void add_glow(const Vertex& vertex, Counts counts);
  void add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half);
  void add_sharp(const Vertex& vertex, PathNumbers& numbers);
  void add_term(const Vec3& wl, const Rgb& light);
  /// Luminance of the light of lamps, environment and surfaces that glow, by Lighting's density.
  void note_density(float density, const Rgb& light);
  float light_density();

  const Scene& scene_;
  const VisibleRays visible_;
  const Lighting& lighting_;
  const RenderOptions (&options_)[2];
  IndirectLight indirect_[2];
  PreparedBrdf prepared_;
  HitLight result_;

  // Of one half: directions that the vertex receives light from.
  DirectionBatch local_, world_;
  RgbBatch environment_, f_;
  ScalarBatch light_pdf_, material_pdf_;
  std::vector<LampHit> lamp_hits_;
  Drawer drawer_[DirectionBatch::kCapacity];
  Hit aims_[DirectionBatch::kCapacity];      // as Lighting::sample gives them
  float weight_[DirectionBatch::kCapacity];  // cos / (n density); 0: aimed at a surface
  Ray rays_[DirectionBatch::kCapacity];
  Hit hits_[DirectionBatch::kCapacity];
  Rgb passed_[DirectionBatch::kCapacity];  // on the way there
  Rgb radiance_[DirectionBatch::kCapacity];
  Rgb glow_[DirectionBatch::kCapacity];  // light of surfaces that glow, weighed
  LightView view_;
  uint8_t view_of_[DirectionBatch::kCapacity] = {};  // all of the one

  // Of both halves.
  struct Concentration {
    float density;
    double luminance;
  };
  std::vector<Concentration> concentrations_;
  double irradiance_ = 0;  // luminance
};

}  // namespace velour
