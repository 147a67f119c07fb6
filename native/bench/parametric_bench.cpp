// What a view and a light direction cost in a parametric material: the model of eight lobes, views and lights at
// random, parameters in the second cache.
#include <benchmark/benchmark.h>

#include "material/parametric_material.h"
#include "sphere/directions.h"
#include "sphere/random.h"
#include "srbf/simd_target.h"
#include "tests/support/parametric_models.h"

namespace velour {
namespace {

std::shared_ptr<const Material> make(bool isotropic, int lobes) {
  std::vector<test::LobeRecipe> recipe;
  RandomStream random(1, 2, 3);
  for (int j = 0; j < lobes; ++j) {
    recipe.push_back({j % 2 ? LobeSpace::light : LobeSpace::half, std::exp2(10 * random.next()), Rgb(random.next()),
                      -random.next(), 0.3f * random.next(), 1});
  }
  return make_parametric_material(std::make_shared<ParametricBrdf>(test::parametric_model(isotropic, recipe)));
}

/// Directions in no order, as a renderer meets them.
struct Directions {
  std::vector<Vec3> wv, wl;
  std::vector<Vec2> u;
  Directions() {
    RandomStream random(4, 5, 6);
    const auto hemisphere = hemisphere_fibonacci(4096);
    for (int i = 0; i < 1024; ++i) {
      wv.push_back(hemisphere[random.next_bits() % 4096]);
      wl.push_back(hemisphere[random.next_bits() % 4096]);
      u.push_back(random.next2());
    }
  }
};

void count(benchmark::State& state, int directions) {
  state.counters["ns_per_light"] = benchmark::Counter(
      1e-9 * directions, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(std::string(simd_target()) + (state.range(0) ? " isotropic, " : " anisotropic, ") +
                 std::to_string(state.range(1)) + " lobes");
}

// Arguments of all: isotropic, lobes.

void parametric_prepare(benchmark::State& state) {
  const auto material = make(state.range(0) != 0, static_cast<int>(state.range(1)));
  const Directions d;
  PreparedBrdf point;
  size_t i = 0;
  for (auto _ : state) {
    material->prepare(d.wv[++i % 1024], point);
    benchmark::DoNotOptimize(point);
  }
  count(state, 1);
}

// One pair a call: a view, and f of one light direction.
void parametric_value(benchmark::State& state) {
  const auto material = make(state.range(0) != 0, static_cast<int>(state.range(1)));
  const Directions d;
  PreparedBrdf point;
  size_t i = 0;
  for (auto _ : state) {
    ++i;
    material->prepare(d.wv[i % 1024], point);
    benchmark::DoNotOptimize(material->eval_one(point, d.wl[i % 1024]));
  }
  count(state, 1);
}

// One pair a call: a view, a sample and its density (and f, which comes with it).
void parametric_sample(benchmark::State& state) {
  const auto material = make(state.range(0) != 0, static_cast<int>(state.range(1)));
  const Directions d;
  PreparedBrdf point;
  size_t i = 0;
  for (auto _ : state) {
    ++i;
    material->prepare(d.wv[i % 1024], point);
    benchmark::DoNotOptimize(material->eval_one(point, material->sample_one(point, d.u[i % 1024])));
  }
  count(state, 1);
}

// A view and 16 light directions.
void parametric_value_16(benchmark::State& state) {
  const auto material = make(state.range(0) != 0, static_cast<int>(state.range(1)));
  const Directions d;
  PreparedBrdf point;
  DirectionBatch wl;
  RgbBatch f;
  ScalarBatch pdf;
  for (int k = 0; k < 16; ++k) wl.push(d.wl[static_cast<size_t>(k)]);
  size_t i = 0;
  for (auto _ : state) {
    material->prepare(d.wv[++i % 1024], point);
    material->eval(point, wl, f, pdf);
    benchmark::DoNotOptimize(f);
  }
  count(state, 16);
}

// A view, 16 samples and their densities.
void parametric_sample_16(benchmark::State& state) {
  const auto material = make(state.range(0) != 0, static_cast<int>(state.range(1)));
  const Directions d;
  PreparedBrdf point;
  DirectionBatch wl;
  RgbBatch f;
  ScalarBatch pdf;
  size_t i = 0;
  for (auto _ : state) {
    i = (i + 16) % 1008;
    material->prepare(d.wv[i], point);
    material->sample(point, {&d.u[i], 16}, wl);
    wl.pad();
    material->eval(point, wl, f, pdf);
    benchmark::DoNotOptimize(pdf);
  }
  count(state, 16);
}

void parametric_build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make(state.range(0) != 0, static_cast<int>(state.range(1))));
  count(state, 1);
}

BENCHMARK(parametric_prepare)->ArgsProduct({{1, 0}, {8, 16}});
BENCHMARK(parametric_value)->ArgsProduct({{1, 0}, {4, 8, 16}});
BENCHMARK(parametric_sample)->ArgsProduct({{1, 0}, {4, 8, 16}});
BENCHMARK(parametric_value_16)->ArgsProduct({{1, 0}, {4, 8, 16}});
BENCHMARK(parametric_sample_16)->ArgsProduct({{1, 0}, {4, 8, 16}});
BENCHMARK(parametric_build)->ArgsProduct({{1, 0}, {8}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace velour
