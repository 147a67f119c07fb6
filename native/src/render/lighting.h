// All light of a scene: the environment and lamps with extent as one density over directions, surfaces that glow as
// another beside it, sharp lamps by name.
#pragma once

#include <span>
#include <vector>

#include "render/glowing_surfaces.h"
#include "render/lamp.h"
#include "scene/scene.h"

namespace velour {

/// A direction of a batch that meets a lamp.
struct LampHit {
  int direction;  // its place in the batch
  const Lamp* lamp;
  float distance;
};

class Lighting {
 public:
  /// Throws Error(cancelled).
  Lighting(const Scene& scene, const Progress& progress);

  const Environment& environment() const { return environment_; }
  /// Of the power of all that a sampled direction can meet, the environment's; the probability of `sample` choosing it.
  float environment_share() const { return environment_probability_; }
  /// True when there is anything that a sampled direction can meet.
  bool has_extended() const { return !lamps_.empty() || !environment_.black() || !glow_.empty(); }

  /// Directions towards light, one for each `u` from its `position`: first a light with probability proportional to its
  /// power, then a direction of it. A zero vector where the chosen lamp shows its dark side. Needs has_extended().
  ///
  /// One that is aimed at a point of a surface that glows brings the light of that point and nothing else, so that only
  /// that point's density need be known: `aims`, as many or none, gets the point, and of the others no instance.
  void sample(std::span<const Vec3> position, std::span<const Vec2> u, DirectionBatch& world,
              std::span<Hit> aims = {}) const;
  /// For each direction of `world` from its `position`: radiance of the environment, density of `sample`, less what it
  /// aims at surfaces, and lamps met (appended to `hits`). The batch is padded.
  void look_up(std::span<const Vec3> position, const DirectionBatch& world, RgbBatch& environment, ScalarBatch& pdf,
               std::vector<LampHit>& hits) const;

  const GlowingSurfaces& glow() const { return glow_; }
  /// Density of `sample` aiming at what a ray has hit.
  float glow_pdf(const Vec3& position, const Vec3& direction, const Hit& hit) const {
    return (1.0f - glow_begin_) * glow_.pdf(position, direction, hit);
  }

  std::span<const Lamp> sharp() const { return sharp_; }
  /// Index of a sharp lamp with probability proportional to its power, which goes to `probability`.
  size_t choose_sharp(float u, float& probability) const;

 private:
  bool choose_environment(Vec2& u) const;
  Vec3 sample_lamp(const Vec3& position, const Vec2& u) const;
  Vec3 sample_glow(const Vec3& position, const Vec2& u, Hit* aim) const;
  void set_probabilities(float environment_power);

  const Environment& environment_;
  std::vector<Lamp> lamps_, sharp_;
  std::vector<float> probability_;  // of lamps_
  float environment_probability_ = 0;
  const GlowingSurfaces glow_;
  float glow_begin_ = 1;  // from this number on a random one chooses a surface
  std::vector<float> sharp_cdf_;
};

}  // namespace velour
