// How well models' densities fit a measurement and themselves: relative variance of f cos(theta_l) / pdf of a sample,
// with f of either, by view angle, one JSON object a line. Of scattered models also with the dissertation's density.
// Arguments: a measurement, then models.
#include <cmath>
#include <cstdio>
#include <exception>

#include "brdf/fit/ggx_fit.h"
#include "math/sphere/random.h"
#include "model/file/model_file.h"
#include "model/model.h"

namespace {

using namespace velour;

constexpr float kAngles[] = {5, 15, 30, 45, 60, 75, 80, 85, 88};
constexpr uint64_t kSamples = 1 << 16;

struct Spread {
  double variance, below;  // relative; share of draws that brought nothing
};

/// `measurement` null: f is the material's.
Spread spread(const Measurement* measurement, const PreparedBrdf& point, const Vec3& wv) {
  double sum = 0, sum_sq = 0;
  int below = 0;
  for (uint64_t i = 0; i < kSamples; ++i) {
    DirectionBatch wl;
    wl.push(point.sample_one(RandomStream(7, 0, i).next2()));
    wl.pad();
    const Vec3 w = wl.get(0);
    below += w.z <= 0;
    if (w.z <= 0) continue;
    RgbBatch own;
    ScalarBatch pdf;
    point.eval(wl, own, pdf);
    Rgb f = own.get(0);
    uint8_t valid = 1;
    if (measurement != nullptr) measurement->eval(wv, {&w, 1}, {&f, 1}, {&valid, 1});
    const double x = valid ? static_cast<double>(std::max(luminance(f), 0.0f) * w.z / pdf.v[0]) : 0.0;
    sum += x;
    sum_sq += x * x;
  }
  const auto n = static_cast<double>(kSamples);
  return {sum_sq * n / (sum * sum) - 1, below / n};
}

enum class Draws { own, interpolated };
constexpr const char* kDraws[] = {"", ", interpolated views"};

void report(const char* name, const Measurement* measurement, const Material& material, Draws draws) {
  std::printf("{\"density\": \"%s%s\", \"f\": \"%s\"", name, kDraws[static_cast<int>(draws)],
              measurement != nullptr ? "measurement" : "model");
  for (const float degrees : kAngles) {
    const Vec3 wv = direction(radians_from(degrees), 0.3f);
    ScratchArena arena;
    const PrepareOptions options{.interpolated_draws = draws == Draws::interpolated};
    const PreparedBrdf* const point = material.prepare(wv, SurfaceSite::everywhere(), options, arena);
    const Spread s = spread(measurement, *point, wv);
    std::printf(", \"%g\": [%.3f, %.3f]", static_cast<double>(degrees), s.variance, s.below);
  }
  std::printf("}\n");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) return 2;
  const auto measurement = load_measurement(argv[1]);
  Progress progress;
  report("ggx", measurement.get(), *make_ggx_material(fit_ggx(*measurement, 0, progress)), Draws::own);
  for (int i = 2; i < argc; ++i) {
    const auto model = std::make_shared<const Model>(load_model(argv[i]));
    const auto material = make_material(model, 0);
    const bool scattered = std::holds_alternative<PerViewBrdf>(model->body);
    for (const Measurement* f :
         {static_cast<const Measurement*>(measurement.get()), static_cast<const Measurement*>(nullptr)}) {
      report(argv[i], f, *material, Draws::own);
      if (scattered) report(argv[i], f, *material, Draws::interpolated);
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
