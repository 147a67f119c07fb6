// A scene with a little of everything that a render meets.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "support/test_scene.h"

namespace velour::test {

/// Sphere on a square under an uneven sky, a sun and a rectangle.
inline Scene busy_scene(std::shared_ptr<const Material> material = std::make_shared<Lambert>(0.5f)) {
  Scene scene;
  const uint32_t ground = scene.add_mesh(square(3)), ball = scene.add_mesh(sphere(12));
  scene.add_material({std::move(material), Rgb(0.0f), false});
  scene.add_instance(ground, {}, {0});
  scene.add_instance(ball, shift({0, 0, 1}), {0});
  std::vector<float> pixels(3 * 8 * 4);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i % 7) * 0.2f;
  scene.set_environment(Environment::image({8, 4, 3, pixels}, 1, Mat3(1.0f)));
  scene.add_light({});
  Light rectangle;
  rectangle.type = Light::Type::rectangle;
  rectangle.size = {1, 1};
  rectangle.color = Rgb(20.0f);
  rectangle.light_to_world = shift({2, 0, 3});
  scene.add_light(rectangle);
  scene.set_camera(camera_above(2));
  scene.commit(2);
  return scene;
}

}  // namespace velour::test
