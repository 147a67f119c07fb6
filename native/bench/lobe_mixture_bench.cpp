// The inner loop of the product: value and density of a batch of directions under a mixture, and one sample of it.
#include <benchmark/benchmark.h>

#include "base/simd.h"
#include "bench/arithmetic_peak.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "math/srbf/lobe_mixture.h"

namespace velour {
namespace {

LobeMixture make_mixture(Kernel kernel, int lobes) {
  LobeMixture mixture;
  mixture.clear(kernel);
  const auto centers = hemisphere_fibonacci(lobes);
  RandomStream random(1, 2, 3);
  for (int j = 0; j < lobes; ++j) {
    const float bandwidth = kernel == Kernel::gaussian ? std::exp2(12 * random.next()) : 0.98f * random.next();
    mixture.add(centers[static_cast<size_t>(j)], bandwidth, {0.5f, 0.4f, random.next()});
  }
  mixture.finish(0.05f);
  return mixture;
}

DirectionBatch make_batch(int count) {
  DirectionBatch batch;
  for (const Vec3& w : hemisphere_fibonacci(count)) batch.push(w);
  batch.pad();
  return batch;
}

/// Reports the time per pair of a lobe and a direction, for a loop over `pairs` of them.
void count_pairs(benchmark::State& state, double pairs) {
  state.counters["ns_per_lobe_direction"] =
      benchmark::Counter(pairs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void time_eval(benchmark::State& state, const LobeMixture& mixture, int directions) {
  const DirectionBatch batch = make_batch(directions);
  RgbBatch value;
  ScalarBatch pdf;
  for (auto _ : state) {
    eval_mixture(mixture, batch, value, pdf);
    benchmark::DoNotOptimize(value);
    benchmark::DoNotOptimize(pdf);
  }
}

// The lobes of four neighboring views. Arguments: lobes a view, directions.
void eval_neighbors(benchmark::State& state) {
  constexpr int kViews = 4;
  const int lobes = kViews * static_cast<int>(state.range(0)), directions = static_cast<int>(state.range(1));
  const LobeMixture mixture = make_mixture(Kernel::gaussian, lobes);
  time_eval(state, mixture, directions);
  state.counters["ns_per_lobe"] =
      benchmark::Counter(lobes * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  const double pairs = static_cast<double>(lobes) * directions;
  count_pairs(state, pairs);
  state.counters["share_of_peak"] =
      benchmark::Counter(pairs * arithmetic_peak_seconds(), benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(simd_target());
}
BENCHMARK(eval_neighbors)->ArgsProduct({{4, 8, 16, 32}, {8, 16, 64}});

// Arguments: kernel, lobes, directions.
void eval_lobe_mixture(benchmark::State& state) {
  const int lobes = static_cast<int>(state.range(1)), directions = static_cast<int>(state.range(2));
  const LobeMixture mixture = make_mixture(static_cast<Kernel>(state.range(0)), lobes);
  time_eval(state, mixture, directions);
  count_pairs(state, static_cast<double>(lobes) * directions);
  state.SetLabel(std::string(simd_target()) + " " + kernel_name(mixture.kernel));
}
BENCHMARK(eval_lobe_mixture)->ArgsProduct({{0}, {4, 8, 16, 32}, {8, 16, 64}})->ArgsProduct({{1}, {16}, {8, 16, 64}});

void eval_on_target(benchmark::State& state, const std::string& target) {
  select_simd_target(target.c_str());
  eval_lobe_mixture(state);
  select_simd_target("auto");
}

// Arguments: kernel, lobes, directions.
void sample_lobe_mixture(benchmark::State& state) {
  const LobeMixture mixture = make_mixture(static_cast<Kernel>(state.range(0)), static_cast<int>(state.range(1)));
  std::vector<Vec2> u(static_cast<size_t>(state.range(2)));
  RandomStream random(1, 2, 3);
  DirectionBatch w;
  for (auto _ : state) {
    for (Vec2& v : u) v = random.next2();
    sample_mixture(mixture, u, w);
    benchmark::DoNotOptimize(w);
  }
  state.counters["ns_per_direction"] =
      benchmark::Counter(static_cast<double>(state.range(2)) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
// What the random numbers of the benchmark above cost.
void random_numbers(benchmark::State& state) {
  RandomStream random(1, 2, 3);
  for (auto _ : state) benchmark::DoNotOptimize(random.next2());
}
BENCHMARK(random_numbers);
BENCHMARK(sample_lobe_mixture)->ArgsProduct({{0, 1}, {4, 32}, {1, 4, 64}});

const bool registered = [] {
  for (const std::string& target : simd_targets()) {
    benchmark::RegisterBenchmark(("eval_on/" + target).c_str(), eval_on_target, target)->Args({0, 16, 16});
  }
  return true;
}();

}  // namespace
}  // namespace velour
