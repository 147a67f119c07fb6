// All light of a scene: the environment, and lamps with extent, as one density over directions at a place; surfaces
// that glow as another beside it; sharp lamps by name.
#pragma once

#include <span>
#include <vector>

#include "render/glowing_surfaces.h"
#include "render/lamp.h"
#include "scene/scene.h"
#include "scene/sky_irradiance.h"

namespace velour {

/// A direction of a batch that meets a lamp.
struct LampHit {
  int direction;  // its place in the batch
  const Lamp* lamp;
  float distance;
};

/// A place and the probabilities of the lights there.
struct LightView {
  LightPlace place;
  float environment = 0, suns = 0, near = 0;  // of the environment, of all suns, of the tree's lights; 1 in all
  double suns_total = 0;                      // of their irradiances
  LightTree::Cut cut;
};

class Lighting {
 public:
  /// Throws Error(cancelled).
  Lighting(const Scene& scene, const Progress& progress);

  const Environment& environment() const { return environment_; }
  /// True when there is anything that a sampled direction can meet.
  bool has_extended() const { return !environment_.black() || !suns_.empty() || !lamps_.empty() || !glow_.empty(); }

  /// Of all but sharp lamps: environment, suns and near lights are chosen by the irradiance that each would bring if
  /// nothing stood before it (of near lights, estimated by LightTree), and at least three tenths of an equal part: what
  /// stands before one is not known. Needs has_extended().
  LightView view(const LightPlace& place) const;

  /// Directions towards light, one for each `u` from its view: first a light, then a direction of it. A zero vector
  /// where the chosen lamp shows its dark side.
  ///
  /// One that is aimed at a point of a surface that glows brings the light of that point and nothing else, so that only
  /// that point's density need be known: `aims`, as many or none, gets the point, and of the others no instance.
  void sample(std::span<const LightView> views, std::span<const uint8_t> view_of, std::span<const Vec2> u,
              DirectionBatch& world, std::span<Hit> aims = {}) const;
  /// For each direction of `world` from its view: radiance of the environment, density of `sample`, less what it aims
  /// at surfaces, and lamps met (appended to `hits`). The batch is padded.
  void look_up(std::span<const LightView> views, std::span<const uint8_t> view_of, const DirectionBatch& world,
               RgbBatch& environment, ScalarBatch& pdf, std::vector<LampHit>& hits) const;

  const GlowingSurfaces& glow() const { return glow_; }
  /// Density of `sample` aiming at what a ray has hit.
  float glow_pdf(const LightView& view, const Vec3& direction, const Hit& hit) const;

  std::span<const Lamp> sharp() const { return sharp_; }
  /// The same of sharp lamps.
  LightView sharp_view(const LightPlace& place) const;
  /// Index of a sharp lamp, and the probability with which it was chosen.
  size_t choose_sharp(const LightView& view, float u, float& probability) const;

 private:
  struct Chosen {
    size_t lamp;
    double probability, rest;  // of the number that chose it
  };
  static LightView view_of_all(const LightPlace& place, double sky, std::span<const Lamp> suns, const LightTree& near);
  static Chosen choose_sun(const LightView& view, std::span<const Lamp> suns, double x);
  Vec3 sample_sun(const LightView& view, double x, float y) const;
  Vec3 sample_near(const LightView& view, const Vec2& u, Hit* aim) const;

  const Environment& environment_;
  const SkyIrradiance sky_;
  std::vector<Lamp> suns_, lamps_;  // with extent
  const GlowingSurfaces glow_;
  LightTree near_;           // of lamps_, then of the glow's lights
  std::vector<Lamp> sharp_;  // suns first
  size_t sharp_suns_ = 0;
  LightTree sharp_near_;  // of the others
};

}  // namespace velour
