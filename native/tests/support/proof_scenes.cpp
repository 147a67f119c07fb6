#include "support/proof_scenes.h"

#include "brdf/eval/parametric_material.h"
#include "material/principled/principled_material.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/changed_material.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/test_scene.h"

namespace velour::test {

namespace {

/// The material with a density that is not its own.
std::shared_ptr<const Material> with_density_times(float factor, std::shared_ptr<const Material> material) {
  return std::make_shared<ChangedMaterial>(std::move(material),
                                           [factor](const DirectionBatch& wl, RgbBatch&, ScalarBatch& pdf) {
                                             for (int i = 0; i < wl.count; ++i) pdf.v[i] *= factor;
                                           });
}

/// Fills a scene whose errors are those of a control.
class Builder {
 public:
  explicit Builder(const SceneError& error) : error_(error) {}

  uint32_t material(std::shared_ptr<const Material> material) {
    if (error_.density != 1) material = with_density_times(error_.density, std::move(material));
    return scene.add_material({std::move(material), Rgb(0.0f), false});
  }
  void object(Mesh mesh, const Affine& place, uint32_t material) {
    scene.add_instance(scene.add_mesh(std::move(mesh)), place, {material});
  }
  void light(Light light) {
    light.color *= error_.light;
    scene.add_light(light);
  }
  void sky(int width, int height, const std::vector<float>& rgb) {
    scene.set_environment(Environment::image({width, height, 3, rgb}, error_.light, Mat3(1.0f)));
  }
  void constant_sky(const Rgb& radiance) { scene.set_environment(Environment::constant(error_.light * radiance)); }
  Scene finish(const Vec3& eye, const Vec3& target, float angle) {
    scene.set_camera(Camera::look_at(eye, target, {0, 0, 1}, angle, 1));
    scene.commit(2);
    return std::move(scene);
  }

  Scene scene;

 private:
  SceneError error_;
};

/// A sky that brightens upwards, and a sun with nine times its energy.
void add_sun(Builder& builder, float degrees, int height) {
  const Vec3 sun = direction(0.8f, -0.9f);
  const float half_chord = 2 * std::sin(radians_from(0.25f * degrees));
  const int width = 2 * height;
  std::vector<float> rgb;
  std::vector<size_t> inside;
  double environment_energy = 0, sun_area = 0;
  for (int y = 0; y < height; ++y) {
    const float theta = kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    for (int x = 0; x < width; ++x) {
      const Vec3 w = direction(theta, 2 * kPi * (0.5f - (static_cast<float>(x) + 0.5f) / static_cast<float>(width)));
      const Rgb sky = (1 + 0.8f * w.z) * Rgb(0.6f, 0.8f, 1);
      if (glm::distance(w, sun) < half_chord) {
        inside.push_back(rgb.size());
        sun_area += std::sin(static_cast<double>(theta));
      }
      environment_energy += static_cast<double>(luminance(sky) * std::sin(theta));
      rgb.insert(rgb.end(), {sky.r, sky.g, sky.b});
    }
  }
  for (const size_t i : inside) std::fill_n(&rgb[i], 3, static_cast<float>(9 * environment_energy / sun_area));
  builder.sky(width, height, rgb);
}

void add_noisy_sky(Builder& builder, float contrast) {
  std::vector<float> rgb(3 * 32 * 16);
  RandomStream random(3, 3, 3);
  for (float& v : rgb) v = 2 * std::pow(random.next(), contrast);
  builder.sky(32, 16, rgb);
}

Scene sphere_under_sun(Builder b, float degrees, int rows) {
  b.object(sphere(24), {}, b.material(highlight_material(40)));
  b.object(square(4), shift({0, 0, -1}), b.material(make_parametric_material(parametric_highlight(120, false))));
  add_sun(b, degrees, rows);
  return b.finish({0, -6, 3}, {0, 0, -0.2f}, 0.55f);
}

/// Two dozen lamps of every kind; those without extent are more than the four that are all lit by name.
void add_lamps(Builder& b) {
  RandomStream random(8, 8, 8);
  for (int i = 0; i < 18; ++i) {
    Light lamp;
    constexpr Light::Type kTypes[] = {Light::Type::rectangle, Light::Type::disk, Light::Type::point};
    lamp.type = kTypes[i % 3];
    lamp.size = Vec2(lamp.type == Light::Type::point ? 0.4f : 1.2f);
    lamp.light_to_world = shift({4 * random.next() - 2, 4 * random.next() - 2, 2.2f + random.next()});
    lamp.color = 8 * random.next() * Rgb(1, 0.9f + 0.1f * random.next(), 0.8f);
    lamp.casts_shadow = i != 5;
    b.light(lamp);
  }
  for (int i = 0; i < 6; ++i) {
    Light lamp;
    lamp.type = i < 4 ? Light::Type::point : Light::Type::sun;
    lamp.light_to_world = shift({static_cast<float>(i) - 2, -1, 2 + 0.3f * static_cast<float>(i)});
    lamp.color = Rgb(i < 4 ? 4.0f : 0.05f);
    b.light(lamp);
  }
  Light sun;
  sun.angle = 0.5f;
  sun.color = Rgb(0.2f);
  b.light(sun);
}

Scene metal_under_lamps(Builder b) {
  b.object(sphere(24), {}, b.material(make_principled_material({{0.9f, 0.7f, 0.4f}, 1.0f, 0.5f, 0.5f})));
  b.object(square(4), shift({0, 0, -1}), b.material(highlight_material(20)));
  add_lamps(b);
  return b.finish({0, -6, 3}, {0, 0, -0.2f}, 0.55f);
}

Scene furnace(Builder b) {
  b.object(sphere(48), {}, b.material(highlight_material(100)));
  b.constant_sky(kFurnace);
  return b.finish({0, -6, 3}, {0, 0, 0}, 0.22f);
}

/// A floor and two walls that shade it, under an uneven sky half hidden by a lid.
Scene corner(Builder b) {
  const uint32_t glossy = b.material(highlight_material(30)),
                 sharp = b.material(make_parametric_material(parametric_highlight(1200, true)));
  b.object(square(1), {}, glossy);
  Affine wall;  // x to y, y to z, z to x
  const float along_x[12] = {0, 0, 1, -1, 1, 0, 0, 0, 0, 1, 0, 1};
  std::copy(along_x, along_x + 12, wall.m);
  b.object(square(1), wall, sharp);
  const float along_y[12] = {0, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1};  // x to z, y to x, z to y
  std::copy(along_y, along_y + 12, wall.m);
  b.object(square(1), wall, glossy);
  b.object(square(0.7f), shift({-0.3f, 0.3f, 1.6f}), glossy);
  add_noisy_sky(b, 6);
  return b.finish({3, -4, 2.5f}, {-0.3f, 0.2f, 0.5f}, 0.5f);
}

Scene two_bounces(Builder b) {
  b.object(sphere(24), {}, b.material(highlight_material(50)));
  b.object(square(4), shift({0, 0, -1.1f}), b.material(highlight_material(10)));
  add_noisy_sky(b, 4);
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.size = {1, 1};
  lamp.color = Rgb(30.0f);
  lamp.light_to_world = shift({1.5f, -1, 3});
  b.light(lamp);
  return b.finish({0, -6, 3}, {0, 0, -0.3f}, 0.5f);
}

}  // namespace

Scene proof_scene(ProofScene kind, const SceneError& error) {
  switch (kind) {
    case ProofScene::sphere_under_sun:
      return sphere_under_sun(Builder(error), 0.5f, 1024);
    case ProofScene::sphere_under_wide_sun:
      return sphere_under_sun(Builder(error), 40, 64);
    case ProofScene::metal_under_lamps:
      return metal_under_lamps(Builder(error));
    case ProofScene::furnace:
      return furnace(Builder(error));
    case ProofScene::corner:
      return corner(Builder(error));
    default:
      return two_bounces(Builder(error));
  }
}

}  // namespace velour::test
