// What one direction pair costs in a material: nanoseconds on one core, random views and lights, parameters in cache.
//
//   evaluation_cost MODEL | MEASUREMENT | MEASUREMENT ggx | MEASUREMENT principled | floor
//
// A model by its own evaluator; a measurement by its own interpolation, which draws no samples; a measurement by the
// peer that is fitted to it; `floor`: a material without arithmetic, what the calls alone cost. Each number is the
// least of many short runs over the same pairs: other programs only ever make one slower. Prints one JSON object:
//   prepare         a view alone
//   f, f_16         a view and 1 light, or 16 of them, per light; the density comes with f
//   sample_pdf, _16 a view, 1 direction drawn for it, or 16 of them, f and density of each, per direction
// and of a parametric model:
//   lobes, f_16_all its lobes that a view evaluates, in the mean, and f_16 were it all of them
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/simd.h"
#include "brdf/eval/parametric_table.h"
#include "brdf/eval/table_sampler.h"
#include "brdf/fit/peer.h"
#include "math/sphere/random.h"
#include "model/file/model_file.h"
#include "model/model.h"

namespace {

using namespace velour;

constexpr int kPairs = 1024;  // directions and numbers of all: 32 KiB, so that they leave the cache to the parameters
constexpr double kSeconds = 0.2;  // of all runs of one number
constexpr int kMany = 16;

struct Pairs {
  std::vector<Vec3> wv, wl;
  std::vector<Vec2> u;

  Pairs() {
    RandomStream random(1, 2, 3);
    for (int i = 0; i < kPairs; ++i) {
      wv.push_back(above_horizon(random.next2()));
      wl.push_back(above_horizon(random.next2()));
      u.push_back(random.next2());
    }
  }

  /// Uniform by solid angle.
  static Vec3 above_horizon(const Vec2& v) { return direction(std::acos(1 - v.x), 2 * kPi * v.y); }
};

/// Keeps the compiler from leaving out what nobody reads.
template <class T>
void used(const T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

/// Nanoseconds of work(i), i in [0, kPairs) by turns.
template <class Work>
double nanoseconds(const Work& work) {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  const auto end = Clock::now() + std::chrono::duration<double>(kSeconds);
  do {
    const auto start = Clock::now();
    for (size_t i = 0; i < kPairs; ++i) work(i);
    least = std::min(least, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  } while (Clock::now() < end);
  return least / kPairs;
}

/// The calls that a renderer makes, and nothing behind them.
class FloorMaterial final : public Material {
 public:
  const PreparedBrdf* prepare(const Vec3& /*wv*/, const SurfaceSite& /*site*/, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<Prepared>();
  }
  bool isotropic() const override { return true; }

 private:
  class Prepared final : public PreparedBrdf {
    void eval(const DirectionBatch&, RgbBatch& f, ScalarBatch& pdf) const override {
      used(f);
      used(pdf);
    }
    void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
      wl.fill(u, [](const Vec2&) { return Vec3(0, 0, 1); });
    }
    Reflection eval_one(const Vec3&) const override { return {}; }
    Vec3 sample_one(const Vec2&) const override { return {0, 0, 1}; }
  };
};

nlohmann::ordered_json cost_of(const Material& material) {
  const Pairs pairs;
  ScratchArena arena;
  const PreparedBrdf* point = nullptr;
  DirectionBatch wl;
  RgbBatch f;
  ScalarBatch pdf;
  const auto prepare = [&](size_t i) {
    arena.reset();
    point = material.prepare(pairs.wv[i], arena);
    used(*point);
  };
  const auto eval = [&] {
    wl.pad();
    point->eval(wl, f, pdf);
    used(f);
    used(pdf);
  };
  const auto f_of = [&](size_t i, size_t lights) {
    prepare(i);
    wl.count = 0;
    for (size_t k = 0; k < lights; ++k) wl.push(pairs.wl[(i + k) % kPairs]);
    eval();
  };
  const auto eval_one = [&](const Vec3& direction) {
    const auto reflection = point->eval_one(direction);
    used(reflection);
  };
  const auto sample_of = [&](size_t i, size_t directions) {
    prepare(i);
    point->sample(std::span(pairs.u).subspan(std::min(i, kPairs - directions), directions), wl);
    eval();
  };
  return {{"prepare", nanoseconds(prepare)},
          {"f", nanoseconds([&](size_t i) {
             prepare(i);
             eval_one(pairs.wl[i]);
           })},
          {"f_16", nanoseconds([&](size_t i) { f_of(i, kMany); }) / kMany},
          {"sample_pdf", nanoseconds([&](size_t i) {
             prepare(i);
             eval_one(point->sample_one(pairs.u[i]));
           })},
          {"sample_pdf_16", nanoseconds([&](size_t i) { sample_of(i, kMany); }) / kMany}};
}

/// What leaving out lobes that cannot matter at a view saves.
nlohmann::ordered_json idle_lobes_of(const ParametricBrdf& brdf, const Material& material) {
  const Pairs pairs;
  const ParametricValues values(brdf);
  const ParametricTable table(values, ParametricNodes(values));
  const auto tables = material.tables();
  WarpedMixture mixture;
  TablePoint point;
  const auto evaluate = [&](const Vec3& wv) {
    if (table.covers(wv)) return table.evaluate(wv, mixture);
    values.evaluate(wv, ViewPlace(wv), mixture);
  };
  double listed = 0;
  for (const Vec3& wv : pairs.wv) {
    evaluate(wv);
    listed += mixture.listed_count;
  }
  DirectionBatch wl;
  RgbBatch f;
  ScalarBatch pdf;
  const auto all = nanoseconds([&](size_t i) {
    evaluate(pairs.wv[i]);
    mixture.list_all();
    if (tables) tables->prepare(pairs.wv[i], point);
    wl.count = 0;
    for (size_t k = 0; k < kMany; ++k) wl.push(pairs.wl[(i + k) % kPairs]);
    wl.pad();
    eval_warped(mixture, wl, f);
    if (tables) TableSampler::pdf(point, wl, pdf);
    used(f);
    used(pdf);
  });
  return {{"lobes", listed / kPairs}, {"f_16_all", all / kMany}};
}

nlohmann::ordered_json cost_of(const Measurement& measurement) {
  const Pairs pairs;
  Rgb f[kMany];
  uint8_t valid[kMany];
  const auto f_of = [&](size_t i, size_t lights) {
    const auto wl = std::span(pairs.wl).subspan(std::min(i, kPairs - lights), lights);
    measurement.eval(pairs.wv[i], wl, {f, lights}, {valid, lights});
    used(f);
  };
  return {{"f", nanoseconds([&](size_t i) { f_of(i, 1); })},
          {"f_16", nanoseconds([&](size_t i) { f_of(i, kMany); }) / kMany}};
}

nlohmann::ordered_json report(const std::string& file, const std::string& peer) {
  if (file == "floor") return cost_of(FloorMaterial());
  if (is_model_file(file)) {
    const auto model = std::make_shared<const Model>(load_model(file));
    const auto material = make_material(model, 0);
    auto json = cost_of(*material);
    if (const auto* brdf = std::get_if<ParametricBrdf>(&model->body)) json.update(idle_lobes_of(*brdf, *material));
    return json;
  }
  const auto measurement = load_measurement(file);
  if (peer.empty()) return cost_of(*measurement);
  if (peer != "ggx" && peer != "principled") throw std::runtime_error("evaluation_cost: no peer is called " + peer);
  Progress progress;
  const Peer which = peer == "ggx" ? Peer::ggx : Peer::principled;
  return cost_of(*make_peer_material(fit_peer(*measurement, which, 0, progress)));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 3) throw std::runtime_error("usage: evaluation_cost FILE [ggx | principled]");
  auto json = report(argv[1], argc == 3 ? argv[2] : "");
  json["simd"] = simd_target();
  std::printf("%s\n", json.dump(2).c_str());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
