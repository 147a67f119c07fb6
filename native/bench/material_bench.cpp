// What a camera ray and a light direction cost in each material and in the tabulated sampler.
#include <benchmark/benchmark.h>

#include "brdf/eval/per_view_material.h"
#include "brdf/eval/table_sampler.h"
#include "material/principled/principled_material.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

PerViewBrdf make_brdf(bool isotropic, int lobes = 16) {
  PerViewBrdf brdf;
  brdf.isotropic = isotropic;
  brdf.default_neighbors = isotropic ? 2 : 4;
  if (isotropic) {
    for (int i = 0; i < 45; ++i) brdf.views.push_back(direction(radians_from(2.0f * static_cast<float>(i)), 0));
  } else {
    brdf.views = hemisphere_fibonacci(400);
  }
  RandomStream random(1, 2, 3);
  brdf.first_lobe = {0};
  for (size_t i = 0; i < brdf.views.size(); ++i) {
    for (const Vec3& center : hemisphere_fibonacci(lobes)) {
      brdf.center.push_back(center);
      brdf.bandwidth.push_back(std::exp2(12 * random.next()));
      brdf.coefficient.push_back({random.next(), random.next(), random.next()});
    }
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  return brdf;
}

enum Choice { kMeridian, kHemisphere, kPrincipled, kTextured };

template <class T>
TextureSlot<T> noise() {
  constexpr int kSide = 512;
  std::vector<T> texels(kSide * kSide);
  RandomStream random(4, 5, 6);
  for (T& t : texels) t = T(random.next());
  return {std::make_shared<const Texture<T>>(kSide, kSide, std::move(texels), TextureOptions{}), {}};
}

std::shared_ptr<const Material> make(int64_t choice) {
  if (choice == kPrincipled) return make_principled_material({.metallic = 0.5f, .roughness = 0.4f});
  if (choice == kTextured) {
    return make_principled_material({}, {noise<Rgb>(), noise<float>(), noise<float>(), {}}, 1);
  }
  return make_per_view_material(std::make_shared<PerViewBrdf>(make_brdf(choice == kMeridian)), 0);
}

void label(benchmark::State& state) {
  const char* const names[] = {"meridian 2 x 16 lobes", "hemisphere 4 x 16 lobes of 400 views", "principled",
                               "principled, three textures"};
  state.SetLabel(names[state.range(0)]);
}

const std::vector<Vec3>& views() {
  static const std::vector<Vec3> set = hemisphere_fibonacci(1024);
  return set;
}

void prepare_material(benchmark::State& state) {
  const auto material = make(state.range(0));
  ScratchArena arena;
  SurfaceSite site{.footprint = Mat2(1.0f / 256)};  // of two texels
  size_t i = 0;
  for (auto _ : state) {
    site.uv = Vec2(views()[++i % 1024]);
    const PreparedBrdf* const point = material->prepare(views()[i % 1024], site, {}, arena);
    benchmark::DoNotOptimize(point);
  }
  label(state);
}
// Four neighboring views found, turned and put together. Argument: lobes a view.
void prepare_neighbors(benchmark::State& state) {
  const int lobes = static_cast<int>(state.range(0));
  const auto material = make_per_view_material(std::make_shared<PerViewBrdf>(make_brdf(false, lobes)), 4);
  ScratchArena arena;
  size_t i = 0;
  for (auto _ : state) {
    const PreparedBrdf* const point = material->prepare(views()[++i % 1024], arena);
    benchmark::DoNotOptimize(point);
  }
  state.counters["ns_per_lobe"] =
      benchmark::Counter(4e-9 * lobes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(prepare_neighbors)->Arg(4)->Arg(8)->Arg(16)->Arg(32);

BENCHMARK(prepare_material)->Arg(kMeridian)->Arg(kHemisphere)->Arg(kPrincipled)->Arg(kTextured);

void eval_material_16(benchmark::State& state) {
  const auto material = make(state.range(0));
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(direction(0.7f, 1), arena);
  DirectionBatch wl;
  for (const Vec3& w : hemisphere_fibonacci(16)) wl.push(w);
  RgbBatch f;
  ScalarBatch pdf;
  for (auto _ : state) {
    point->eval(wl, f, pdf);
    benchmark::DoNotOptimize(f);
    benchmark::DoNotOptimize(pdf);
  }
  label(state);
}
BENCHMARK(eval_material_16)->Arg(kMeridian)->Arg(kHemisphere)->Arg(kPrincipled)->Arg(kTextured);

void sample_material(benchmark::State& state) {
  const auto material = make(state.range(0));
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(direction(0.7f, 1), arena);
  RandomStream random(1, 2, 3);
  for (auto _ : state) benchmark::DoNotOptimize(point->sample_one(random.next2()));
  label(state);
}
BENCHMARK(sample_material)->Arg(kMeridian)->Arg(kHemisphere)->Arg(kPrincipled);

void table_build(benchmark::State& state) {
  const auto material = make(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(TableSampler(*material).bytes());
  label(state);
}
BENCHMARK(table_build)->Arg(kMeridian)->Arg(kHemisphere)->Unit(benchmark::kMillisecond);

void table_sample_16(benchmark::State& state) {
  const TableSampler table(*make(state.range(0)));
  RandomStream random(1, 2, 3);
  TablePoint point;
  DirectionBatch wl;
  for (auto _ : state) {
    table.prepare(direction(0.7f, 1), point);
    Vec2 u[16];
    for (Vec2& v : u) v = random.next2();
    TableSampler::sample(point, u, wl);
    benchmark::DoNotOptimize(wl);
  }
  label(state);
}
BENCHMARK(table_sample_16)->Arg(kMeridian)->Arg(kHemisphere);

void table_pdf_16(benchmark::State& state) {
  const TableSampler table(*make(state.range(0)));
  DirectionBatch wl;
  for (const Vec3& w : hemisphere_fibonacci(16)) wl.push(w);
  ScalarBatch pdf;
  TablePoint point;
  table.prepare(direction(0.7f, 1), point);
  for (auto _ : state) {
    TableSampler::pdf(point, wl, pdf);
    benchmark::DoNotOptimize(pdf);
  }
  label(state);
}
BENCHMARK(table_pdf_16)->Arg(kMeridian)->Arg(kHemisphere);

}  // namespace
}  // namespace velour
