// What one uniform sample of a pixel brings, by importance sampling: its mean and what its spread is made of.
//
//   uniform_moments --mesh M.obj --material DATA --proposal M.velour --world W.hdr --output MOMENTS.exr
//       [--size 80x60] [--rays 8192] [--directions 8] [--seed 1] [--threads 2]
//
// A sample is that of `velour render --strategy uniform --split 1 --sequence random`: a camera ray through the pixel
// and one direction w, uniform over the hemisphere, which bring the luminance
//   X = 2 pi f(w) L(w) cos(w) V(w),   or that of the sky where the ray meets nothing.
// Uniform samples meet the bright and rare X too seldom to tell how rare they are. Here the directions come half from
// the material's sampler and half from the lights, with density d, and each counts 1 / (2 pi d) times:
//   E[X^k] = E_d[X^k / (2 pi d)].
// The picture holds E[X], E[X^2], E[X^3] and the largest X met, as red, green, blue and alpha.
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "described_scene.h"
#include "image/picture.h"
#include "material/material.h"
#include "math/sphere/random.h"
#include "render/lights/lighting.h"
#include "render/vertex.h"

namespace {

using namespace velour;

constexpr double kHemisphere = 2 * kPiD;

struct Moments {
  double power[3] = {};  // sums of X, X^2, X^3
  double largest = 0;

  /// `weight`: how many samples of a uniform kind the value stands for.
  void add(double value, double weight) {
    for (double term = weight; double& sum : power) sum += term *= value;
    largest = std::max(largest, value);
  }
};

/// Directions from one vertex, half of them drawn from the material and half from the lights.
class Directions {
 public:
  Directions(const Scene& scene, const Lighting& lighting, int count)
      : scene_(scene), lighting_(lighting), u_(static_cast<size_t>(count)) {}

  void add(const Vertex& vertex, RandomStream& random, Moments& moments) {
    for (Vec2& u : u_) u = random.next2();
    const LightView view = lighting_.view(vertex.light_place());
    draw(vertex, view);
    if (local_.count == 0) return;
    local_.pad();
    world_.pad();
    RgbBatch f, radiance;
    ScalarBatch surface, lights;
    std::vector<LampHit> none;
    const uint8_t of_view[DirectionBatch::kCapacity] = {};
    point_->eval(local_, f, surface);
    lighting_.look_up({&view, 1}, of_view, world_, radiance, lights, none);
    for (int i = 0; i < world_.count; ++i) {
      const auto reflected = static_cast<double>(luminance(f.get(i) * radiance.get(i)) * local_.z[i]);
      const double density = 0.5 * (static_cast<double>(surface.v[i]) + static_cast<double>(lights.v[i]));
      if (!(reflected > 0) || !(density > 0) || blocked(vertex, world_.get(i))) continue;
      moments.add(kHemisphere * reflected, 1 / (kHemisphere * density * static_cast<double>(u_.size())));
    }
  }

 private:
  void draw(const Vertex& vertex, const LightView& view) {
    const auto half = std::span<const Vec2>(u_).first(u_.size() / 2),
               rest = std::span<const Vec2>(u_).last(half.size());
    const std::vector<uint8_t> of_view(rest.size(), 0);
    local_.count = world_.count = 0;
    arena_.reset();
    point_ = vertex.surface->material->prepare(vertex.wv, arena_);
    point_->sample(half, drawn_);
    for (int i = 0; i < drawn_.count; ++i) keep(vertex, drawn_.get(i), vertex.frame.to_world(drawn_.get(i)));
    lighting_.sample({&view, 1}, of_view, rest, drawn_);
    for (int i = 0; i < drawn_.count; ++i) keep(vertex, vertex.frame.to_local(drawn_.get(i)), drawn_.get(i));
  }

  void keep(const Vertex& vertex, const Vec3& local, const Vec3& world) {
    if (!(local.z > 0.0f) || !(glm::dot(world, vertex.geometric_normal) > 0.0f)) return;
    local_.push(local);
    world_.push(world);
  }

  bool blocked(const Vertex& vertex, const Vec3& world) const {
    return scene_.rays().occluded(vertex.ray(world, std::numeric_limits<float>::infinity()));
  }

  const Scene& scene_;
  const Lighting& lighting_;
  std::vector<Vec2> u_;
  ScratchArena arena_;
  const PreparedBrdf* point_ = nullptr;  // at the last vertex
  DirectionBatch drawn_, local_, world_;
};

double environment_luminance(const Scene& scene, const Vec3& direction) {
  DirectionBatch world;
  RgbBatch radiance;
  ScalarBatch pdf;
  world.push(direction);
  world.pad();
  scene.environment().look_up(world, radiance, pdf);
  return static_cast<double>(luminance(radiance.get(0)));
}

class Study {
 public:
  explicit Study(const Arguments& a)
      : width_(a.width()),
        height_(a.height()),
        rays_(std::stoi(a["rays"])),
        directions_(std::stoi(a["directions"])),
        seed_(std::stoull(a["seed"])),
        lighting_(described(a)) {
    if (directions_ % 2 != 0 || directions_ > DirectionBatch::kCapacity) {
      throw std::runtime_error("uniform_moments: --directions must be even, and at most 64.");
    }
  }

  Picture picture(int threads) const {
    Picture picture{width_, height_, 4, {}};
    picture.pixels.resize(4 * static_cast<size_t>(width_) * static_cast<size_t>(height_));
    tbb::task_arena(threads).execute([&] {
      tbb::parallel_for(0, height_, [&](int y) {
        Directions directions(scene_, lighting_, directions_);
        for (int x = 0; x < width_; ++x) store(pixel(x, y, directions), picture, x, y);
      });
    });
    return picture;
  }

 private:
  Lighting described(const Arguments& a) {
    describe(a, scene_);
    return Lighting(scene_, Progress());
  }

  Moments pixel(int x, int y, Directions& directions) const {
    Moments moments;
    const Vec2 size(static_cast<float>(width_), static_cast<float>(height_));
    const auto number = static_cast<uint64_t>(y) * static_cast<uint64_t>(width_) + static_cast<uint64_t>(x);
    for (int i = 0; i < rays_; ++i) {
      RandomStream random(seed_, number, static_cast<uint64_t>(i));
      const Ray ray = scene_.camera().ray((Vec2(x, y) + random.next2()) / size);
      Hit hit;
      scene_.rays().intersect(ray, hit);
      if (hit.instance == kNoHit) {
        moments.add(environment_luminance(scene_, ray.direction), 1);
        continue;
      }
      const SurfacePoint point = scene_.surface(hit);
      Vertex vertex(point, -ray.direction);
      vertex.surface = &scene_.materials()[point.material];
      directions.add(vertex, random, moments);
    }
    return moments;
  }

  void store(const Moments& moments, Picture& picture, int x, int y) const {
    float* out =
        picture.pixels.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x));
    for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(moments.power[k] / rays_);
    out[3] = static_cast<float>(moments.largest);
  }

  const int width_, height_, rays_, directions_;
  const uint64_t seed_;
  Scene scene_;
  const Lighting lighting_;
};

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments(
      argc, argv, {{"size", "80x60"}, {"rays", "8192"}, {"directions", "8"}, {"seed", "1"}, {"threads", "2"}});
  write_picture(arguments["output"], Study(arguments).picture(std::stoi(arguments["threads"])));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
