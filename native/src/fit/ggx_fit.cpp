#include "fit/ggx_fit.h"

#include <algorithm>
#include <cmath>

#include "fit/ggx_problem.h"

namespace velour {
namespace {

constexpr size_t kDescents = 3;

std::vector<GgxParameters> starts(bool isotropic) {
  std::vector<GgxParameters> out;
  for (int i = 0; i < 10; ++i) {
    const float alpha = 0.005f * std::pow(1.0f / 0.005f, static_cast<float>(i) / 9);
    for (const float stretch : {1.0f, 1.5f, 1 / 1.5f, 2.5f, 1 / 2.5f}) {
      out.push_back({.alpha = glm::min(alpha * Vec2(stretch, 1 / stretch), Vec2(GgxProblem::kLargestAlpha))});
      if (isotropic) break;
    }
  }
  return out;
}

GgxParameters fit(PairSamples samples, bool isotropic, int threads, Progress& progress) {
  if (samples.samples.empty()) return {};
  const GgxProblem problem(std::move(samples), isotropic);
  auto candidates = judged(problem, std::span<const GgxParameters>(starts(isotropic)), threads, progress);
  std::stable_sort(candidates.begin(), candidates.end(), better<GgxParameters>);
  candidates.resize(kDescents);
  return best_descent(problem, std::move(candidates), threads, progress);
}

}  // namespace

GgxParameters fit_ggx(const Material& material, int threads, Progress& progress) {
  return fit(pair_samples(material, threads, progress), material.isotropic(), threads, progress);
}

GgxParameters fit_ggx(const Measurement& measurement, int threads, Progress& progress) {
  return fit(pair_samples(measurement, threads, progress), measurement.isotropic(), threads, progress);
}

}  // namespace velour
