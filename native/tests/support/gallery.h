// A scene that has everything that strategies must agree on.
#pragma once

#include "material/principled/principled_material.h"
#include "math/sphere/random.h"
#include "support/test_scene.h"

namespace velour::test {

/// A glossy sphere over a rough plane, occluding each other, under an uneven sky and every kind of lamp.
inline Scene gallery(float brighter = 1) {
  Scene scene;
  scene.add_mesh(square(4));
  scene.add_mesh(sphere(24));
  scene.add_material({std::make_shared<Lambert>(0.7f), Rgb(0.0f), false});
  scene.add_material({make_principled_material({{0.8f, 0.5f, 0.3f}, 1.0f, 0.5f, 0.5f}), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.add_instance(1, shift({0, 0, 1.1f}), {1});
  std::vector<float> pixels(3 * 16 * 8);
  RandomStream random(3, 3, 3);
  for (float& p : pixels) p = std::pow(random.next(), 4.0f) * 2;
  scene.set_environment(Environment::image({16, 8, 3, pixels}, brighter, Mat3(1.0f)));
  Light sun;
  sun.angle = 0.5f;
  sun.light_to_world.m[2] = 0.6f;
  sun.light_to_world.m[10] = 0.8f;
  scene.add_light(sun);
  sun.angle = 0;
  sun.light_to_world.m[2] = -0.6f;
  sun.color = Rgb(0.5f);
  scene.add_light(sun);
  Light lamp;
  lamp.light_to_world = shift({1.5f, 1.5f, 3});
  for (Light::Type type : {Light::Type::rectangle, Light::Type::disk, Light::Type::point}) {
    lamp.type = type;
    lamp.size = {1, 1};
    lamp.color = Rgb(15.0f);
    lamp.light_to_world.m[3] -= 1.2f;
    scene.add_light(lamp);
  }
  scene.set_camera(Camera::look_at({0, -6, 4}, {0, 0, 0.8f}, {0, 0, 1}, 0.5f, 1));
  scene.commit(2);
  return scene;
}

}  // namespace velour::test
