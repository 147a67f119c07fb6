// Scenes for the proof of observations: a glossy body over a floor, whose f is scaled, lit in several ways. All
// surfaces are gray, so that luminance is linear along every path.
#pragma once

#include "material/derived_materials.h"
#include "math/sphere/random.h"
#include "support/changed_material.h"
#include "support/proof_materials.h"
#include "support/renders.h"
#include "usage/observation.h"
#include "usage/observe/scene_observer.h"

namespace velour::test {

/// Luminance of another material's f, times a factor.
inline std::shared_ptr<const Material> scaled_gray(std::shared_ptr<const Material> material, float factor) {
  return std::make_shared<ChangedMaterial>(std::move(material),
                                           [factor](const DirectionBatch& wl, RgbBatch& f, ScalarBatch&) {
                                             for (int i = 0; i < wl.count; ++i)
                                               f.set(i, Rgb(factor * luminance(f.get(i))));
                                           });
}

enum class ObservedLight { sky, lamps, delta_lights };
inline constexpr uint32_t kObservedMaterial = 0;

inline void add_sky(Scene& scene) {
  std::vector<float> rgb(3 * 32 * 16);
  RandomStream random(3, 3, 3);
  for (float& v : rgb) v = 2 * std::pow(random.next(), 4.0f);
  scene.set_environment(Environment::image({32, 16, 3, rgb}, 1, Mat3(1.0f)));
}

/// One of each kind; one below the floor, which throws no shadow.
inline void add_extended_lamps(Scene& scene) {
  Light lamp;
  lamp.color = {30, 20, 10};
  lamp.type = Light::Type::rectangle;
  lamp.size = {1, 0.5f};
  lamp.light_to_world = shift({1.5f, -1, 3});
  scene.add_light(lamp);
  lamp.type = Light::Type::point;
  lamp.size = {0.3f, 0};
  lamp.casts_shadow = false;
  lamp.light_to_world = shift({0.5f, -2, -2.5f});
  scene.add_light(lamp);
  Light sun;
  sun.angle = 0.3f;
  scene.add_light(sun);
}

/// More than are all lit by name.
inline void add_delta_lights(Scene& scene) {
  for (int i = 0; i < 6; ++i) {
    Light lamp;
    lamp.type = i < 5 ? Light::Type::point : Light::Type::sun;
    lamp.light_to_world = shift({static_cast<float>(i) - 2, -1, i == 2 ? -2.0f : 2 + 0.3f * static_cast<float>(i)});
    lamp.color = Rgb(i < 5 ? 10.0f : 0.5f, 8, 4);
    lamp.casts_shadow = i != 2;
    scene.add_light(lamp);
  }
}

/// Reflects light from the viewer's side and transmits light from the other.
inline std::shared_ptr<const Material> translucent_material() {
  return std::make_shared<const ThroughMaterial>(std::make_shared<Lambert>(0.3f), std::make_shared<Lambert>(0.4f));
}

/// Committed. Half the floor is a mirror-like neighbor that shines itself.
inline Scene observed_scene(ObservedLight light, float factor,
                            std::shared_ptr<const Material> observed = highlight_material(10)) {
  Scene scene;
  const auto add = [&scene](Mesh mesh, const Affine& place, SurfaceMaterial material) {
    scene.add_instance(scene.add_mesh(std::move(mesh)), place, {scene.add_material(std::move(material))});
  };
  add(sphere(24), {}, {scaled_gray(std::move(observed), factor), Rgb(0.0f), false});
  add(square(4), shift({0, 0, -1}), {std::make_shared<Lambert>(0.7f), Rgb(0.0f), false});
  add(square(0.7f), shift({1.2f, -1.2f, -0.9f}), {std::make_shared<Lambert>(0.3f), {1.5f, 2, 1}, false});
  if (light == ObservedLight::sky) add_sky(scene);
  if (light == ObservedLight::lamps) add_extended_lamps(scene);
  if (light == ObservedLight::delta_lights) add_delta_lights(scene);
  scene.set_camera(Camera::look_at({0, -6, 3}, {0, 0, -0.2f}, {0, 0, 1}, 0.5f, 1));
  scene.commit(2);
  return scene;
}

/// Mean over the picture of the luminance that hits send on, were their material's f that of `material`: what the
/// picture gains, to first order, from f.
inline double observed_radiance(const SceneObservation& o, const Material& material) {
  ScratchArena arena;
  double sum = 0;
  for (const ObservedHit& hit : o.hits) {
    const PreparedBrdf* const point = material.prepare(hit.wv, arena);
    for (uint32_t first = hit.first; first < hit.last; first += DirectionBatch::kCapacity) {
      DirectionBatch wl;
      const uint32_t end = std::min<uint32_t>(hit.last, first + DirectionBatch::kCapacity);
      for (uint32_t i = first; i < end; ++i) wl.push(o.wl[i]);
      wl.pad();
      RgbBatch f;
      ScalarBatch pdf;
      point->eval(wl, f, pdf);
      for (uint32_t i = first; i < end; ++i) {
        sum += 0.5 * static_cast<double>(luminance(f.get(static_cast<int>(i - first)) * o.light[i]));
      }
    }
  }
  return sum / static_cast<double>(o.hits.size()) * o.domain.weight() / static_cast<double>(o.domain.camera_rays);
}

}  // namespace velour::test
