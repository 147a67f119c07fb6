// Shells of surfaces that move or deform: rays meet the structure where it is at their time.
#include <gtest/gtest.h>

#include <vector>

#include "math/sphere/random.h"
#include "render/path/shadow_queue.h"
#include "render/path/vertex.h"
#include "support/example_shell.h"
#include "support/test_scene.h"

namespace velour::shell_motion_test {
namespace {

const Vec3 kWay(0.6f, -0.2f, 0.4f);  // from the opening of the shutter to its close
constexpr int kRays = 4000;

enum class Kind { still, moving, deforming };

/// A square of side 2 with wires along y, four tiles wide.
Scene wires(Kind kind) {
  const std::vector<Vec3> p = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  std::vector<Vec2> uv;
  for (const glm::uvec3& corner : t) {
    for (int k = 0; k < 3; ++k) uv.push_back(2.0f * (Vec2(p[corner[k]]) + 1.0f));
  }
  std::vector<Vec3> shapes;
  for (const float side : {-0.5f, 0.5f}) {
    for (const Vec3& corner : p) shapes.push_back(corner + side * kWay);
  }
  Scene scene;
  scene.add_material({.material = std::make_shared<test::Lambert>(1.0f),
                      .shell = std::make_shared<const ShellField>(test::wires(64, 0.2f)),
                      .shell_shaded = true});
  const bool deforms = kind == Kind::deforming;
  scene.add_mesh(Mesh({.positions = p,
                       .triangles = t,
                       .corner_uvs = uv,
                       .steps = deforms ? 2u : 0u,
                       .moved_positions = deforms ? std::span<const Vec3>(shapes) : std::span<const Vec3>()}));
  std::vector<Affine> steps = {test::shift(-0.5f * kWay), test::shift(0.5f * kWay)};
  if (kind != Kind::moving) steps = {Affine{}};
  scene.add_moving_instance(0, steps, {0});
  Camera camera = test::camera_above(1);
  camera.shutter.emplace();
  scene.set_camera(camera);
  scene.commit(1);
  return scene;
}

Ray ray_of(uint64_t number) {
  RandomStream random(5, number, 0);
  const Vec2 from = random.next2(), to = random.next2();
  const Vec3 origin(3.0f * from.x - 1.5f, 3.0f * from.y - 1.5f, 1.5f), end(2.2f * to.x - 1.1f, 2.2f * to.y - 1.1f, 0);
  return {origin, 0, glm::normalize(end - origin), std::numeric_limits<float>::infinity(), random.next()};
}

TEST(ShellMotion, RaysMeetTheStructureWhereItIs) {
  const Scene still = wires(Kind::still);
  const VisibleRays still_rays(still);
  for (const Kind kind : {Kind::moving, Kind::deforming}) {
    const Scene scene = wires(kind);
    const VisibleRays rays(scene);
    int met = 0, other = 0, unmoved = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = ray_of(static_cast<uint64_t>(i));
      Ray along = ray;  // with the structure
      const Vec3 by = (ray.time - 0.5f) * kWay;
      along.origin += by;
      Hit expected, found, at_once;
      still_rays.intersect({&ray, 1}, &expected);
      rays.intersect({&along, 1}, &found);
      along.time = 0.5f;
      rays.intersect({&along, 1}, &at_once);
      const bool is_met = expected.instance != kNoHit;
      if (is_met != (found.instance != kNoHit)) ++other;
      if (is_met != (at_once.instance != kNoHit)) ++unmoved;
      if (!is_met || found.instance == kNoHit) continue;
      ++met;
      along.time = ray.time;
      const Vertex one = Vertex::seen(still, ray, expected, {}, nullptr);
      const Vertex moved = Vertex::seen(scene, along, found, {}, nullptr);
      if (glm::length(moved.position - by - one.position) > 1e-3f || glm::dot(moved.frame.z, one.frame.z) < 0.99f)
        ++other;
    }
    EXPECT_GT(met, kRays / 10);
    EXPECT_LT(other, kRays / 100);   // rounding at edges
    EXPECT_GT(unmoved, kRays / 10);  // the control
  }
}

}  // namespace
}  // namespace velour::shell_motion_test
