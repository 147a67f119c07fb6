// All light of a scene: the environment and lights with extent as one density over directions at a point; emissive
// meshes as a second one; delta lights one by one.
#pragma once

#include <span>
#include <vector>
#include "light/environment.h"
#include "render/lights/area_light.h"
#include "render/lights/emissive_meshes.h"
#include "render/path/path_numbers.h"
#include "render/path/vertex.h"
#include "scene/scene.h"

namespace velour {

/// A direction of a batch that hits a light.
struct LampHit {
  int direction;  // index in the batch
  const Lamp* lamp;
  float distance;
};

/// A point and the selection probabilities of the lights there.
struct LightView {
  LightPlace place;
  float environment = 0, suns = 0, near = 0;  // probabilities: environment, all suns, lights of the tree; sum 1
  double suns_total = 0;                      // sum of their irradiances
  LightTree::Cut cut;
};

class Lighting {
 public:
  /// Throws Error(cancelled).
  Lighting(const Scene& scene, const Progress& progress);

  const Environment& environment() const { return environment_; }
  /// Whether there is anything that a sampled direction can hit.
  bool has_extended() const { return !environment_.black() || !suns_.empty() || !lamps_.empty() || !emissive_.empty(); }

  /// For all but delta lights. Environment, suns and near lights are chosen by their unoccluded irradiance (for near
  /// lights, estimated by LightTree), mixed with three tenths of a uniform choice, since occlusion is unknown. Needs
  /// has_extended().
  LightView view(const LightPlace& place) const;

  /// Samples directions toward light, one for each `u` from its view: first a light, then a direction to it. A zero
  /// vector if the chosen light shows its dark side.
  ///
  /// A direction aimed at a point of an emissive mesh carries the light of that point alone, so that only the density
  /// of that point need be known. `aims`, one per direction or empty, receives the point; for other directions it has
  /// no instance.
  void sample(std::span<const LightView> views, std::span<const uint8_t> view_of, std::span<const Vec2> u,
              DirectionBatch& world, std::span<Hit> aims = {}) const;
  /// For each direction of `world` from its view: radiance of the environment, density of `sample` without directions
  /// aimed at emissive meshes, and lights hit (appended to `hits`). The batch is padded.
  void look_up(std::span<const LightView> views, std::span<const uint8_t> view_of, const DirectionBatch& world,
               RgbBatch& environment, ScalarBatch& pdf, std::vector<LampHit>& hits) const;

  const EmissiveMeshes& emissive() const { return emissive_; }
  /// Density with which `sample` aims at the point that a ray has hit.
  float emissive_pdf(const LightView& view, const Vec3& direction, const Hit& hit) const;

  std::span<const Lamp> sharp() const { return sharp_; }
  /// Like view(), for delta lights.
  LightView sharp_view(const LightPlace& place) const;
  /// Index of a delta light, and the probability of choosing it.
  size_t choose_sharp(const LightView& view, float u, float& probability) const;

 private:
  struct Chosen {
    size_t lamp;
    double probability, rest;  // rest: residual of the number that chose the light
  };
  static LightView view_of_all(const LightPlace& place, double sky, std::span<const Lamp> suns, const LightTree& near);
  static Chosen choose_sun(const LightView& view, std::span<const Lamp> suns, double x);
  Vec3 sample_sun(const LightView& view, double x, float y) const;
  Vec3 sample_near(const LightView& view, const Vec2& u, Hit* aim) const;

  const Environment& environment_;
  const EnvironmentIrradiance sky_;
  std::vector<Lamp> suns_, lamps_;  // with extent
  const EmissiveMeshes emissive_;
  LightTree near_;           // lamps_, then emissive_.lights()
  std::vector<Lamp> sharp_;  // suns first
  size_t sharp_suns_ = 0;
  LightTree sharp_near_;  // delta lights except suns
};

// Delta lights, which no sampled direction can hit, at one vertex.

/// Light of a delta light that is above both the shading horizon and the surface; ignores shadows.
struct SharpLight {
  const Lamp* lamp;
  float distance;
  Vec3 wl, wl_world;
  Rgb irradiance;  // perpendicular, divided by the selection probability
};

inline constexpr size_t kMaxDeltaLights = 64;

/// Finds each delta light once if `found` has room for all (up to kMaxDeltaLights), otherwise as many as it has room
/// for, sampled by contribution (Lighting::sharp_view). Returns the number of lights in `found`: those that illuminate
/// the vertex.
int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers, std::span<SharpLight> found);

}  // namespace velour
