// Pictures that materials of BTFs are judged by.
#pragma once

#include <memory>

#include "math/sphere/random.h"
#include "support/proof_strategies.h"
#include "support/renders.h"
#include "support/textured_scenes.h"

namespace velour::test {

/// A BTF sphere over a BTF floor of many tiles under an uneven sky and a lamp.
inline Scene two_objects(const std::shared_ptr<const Material>& material, float light = 1) {
  Scene scene;
  const uint32_t number = scene.add_material({.material = material});
  scene.add_instance(scene.add_mesh(textured_sphere(16)), {}, {number});
  scene.add_instance(scene.add_mesh(repeating_square(3, 20)), shift({0, 0, -1}), {number});
  std::vector<float> sky(3 * 16 * 8);
  RandomStream random(5, 5, 5);
  for (float& v : sky) v = light * random.next() * random.next();
  scene.set_environment(Environment::image({16, 8, 3, sky}, 1, Mat3(1.0f)));
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.size = {1.5f, 1.5f};
  lamp.color = Rgb(20 * light);
  lamp.light_to_world = shift({1, -1, 3});
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0, -6, 3}, {0, 0, -0.2f}, {0, 0, 1}, 0.55f, 1));
  scene.commit(2);
  return scene;
}

inline PictureMeans strategy_means(const Scene& scene, const NamedStrategy& s, double factor = 1, uint64_t seed = 1) {
  // The cosine seldom finds the lamp.
  const bool blind = s.strategy != Strategy::light && !is_mixed(s.strategy);
  RenderOptions options = small_options(s.strategy, static_cast<int>((blind ? 768 : 192) * factor));
  options.heuristic = s.heuristic;
  options.light_share = s.light_share;
  options.bounces = 1;
  return independent_renders(scene, options, 16, seed);
}

}  // namespace velour::test
