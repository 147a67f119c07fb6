#include "fit/ggx_fit.h"

#include <algorithm>
#include <cmath>

#include "fit/evaluate.h"
#include "fit/ggx_problem.h"
#include "fit/parallel.h"
#include "fit/view_grid.h"
#include "material/ggx.h"

namespace velour {
namespace {

/// f of each wl for one view; `covered` comes filled with 1.
using Source =
    std::function<void(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> covered)>;

constexpr int kRings = 32, kSpokes = 16;
constexpr float kFloor = 1e-3f;  // of the mean f cos

/// In the middles of five degrees, which is as far from the held-out views as can be.
std::vector<Vec3> views_of(bool isotropic) {
  constexpr int kTurns = 8;
  std::vector<Vec3> views;
  for (int i = 0; i < 18; i += isotropic ? 1 : 2) {
    for (int k = 0; k < (isotropic ? 1 : kTurns); ++k) {
      const float turn = (static_cast<float>(k) + 0.25f) / kTurns;
      views.push_back(direction(radians_from(5.0f * static_cast<float>(i) + 2.5f), isotropic ? 0 : 2 * kPi * turn));
    }
  }
  return views;
}

/// The samples of one view; none where it is black.
std::vector<GgxSample> samples_of(const Source& source, const Vec3& wv) {
  LightGrid grid = light_grid(wv, kRings, kSpokes);
  std::vector<Rgb> f(grid.wl.size());
  std::vector<uint8_t> covered(grid.wl.size(), 1);
  source(wv, grid.wl, f, covered);
  redistribute_weights(grid, covered);
  std::vector<GgxSample> samples;
  double albedo = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    if (!covered[i]) continue;
    const Rgb f_cos = glm::max(f[i], Rgb(0)) * grid.wl[i].z;
    samples.push_back({{.wl = grid.wl[i], .wv = wv}, f_cos, grid.weight[i]});
    albedo += grid.weight[i] * luminance(f_cos);
  }
  if (!(albedo > 0)) return {};
  const float sin_2_theta = wv.z * std::sqrt(wv.x * wv.x + wv.y * wv.y);
  for (GgxSample& s : samples) s.weight *= sin_2_theta / static_cast<float>(albedo);
  return samples;
}

std::vector<GgxSample> all_samples(const Source& source, bool isotropic, int threads, Progress& progress) {
  const std::vector<Vec3> views = views_of(isotropic);
  std::vector<std::vector<GgxSample>> of_view(views.size());
  parallel_for_each(views.size(), threads, progress, [&](size_t i) { of_view[i] = samples_of(source, views[i]); });
  std::vector<GgxSample> samples;
  for (const auto& some : of_view) samples.insert(samples.end(), some.begin(), some.end());
  return samples;
}

float mean_of(std::span<const GgxSample> samples) {
  double sum = 0, weights = 0;
  for (const GgxSample& s : samples) {
    sum += s.weight * luminance(s.f_cos);
    weights += s.weight;
  }
  return weights > 0 ? static_cast<float>(sum / weights) : 0;
}

std::vector<Vec2> starting_alphas(bool isotropic) {
  std::vector<Vec2> alphas;
  for (int i = 0; i < 10; ++i) {
    const float alpha = 0.005f * std::pow(1.0f / 0.005f, static_cast<float>(i) / 9);
    for (const float stretch : {1.0f, 1.5f, 1 / 1.5f, 2.5f, 1 / 2.5f}) {
      alphas.emplace_back(glm::min(alpha * Vec2(stretch, 1 / stretch), Vec2(GgxProblem::kLargestAlpha)));
      if (isotropic) break;
    }
  }
  return alphas;
}

struct Candidate {
  GgxParameters parameters;
  double cost;
};

bool better(const Candidate& a, const Candidate& b) { return a.cost < b.cost; }

GgxParameters fit(const Source& source, bool isotropic, int threads, Progress& progress) {
  auto samples = all_samples(source, isotropic, threads, progress);
  const float mean = mean_of(samples);
  if (!(mean > 0)) return {};
  const GgxProblem problem(std::move(samples), kFloor * mean, isotropic);

  const std::vector<Vec2> alphas = starting_alphas(isotropic);
  std::vector<Candidate> candidates(alphas.size());
  parallel_for_each(alphas.size(), threads, progress, [&](size_t i) {
    candidates[i].parameters = problem.reflectances(alphas[i]);
    candidates[i].cost = problem.cost(candidates[i].parameters);
  });
  std::stable_sort(candidates.begin(), candidates.end(), better);
  candidates.resize(3);
  parallel_for_each(candidates.size(), threads, progress, [&](size_t i) {
    Candidate& c = candidates[i];
    c.parameters = problem.polish(c.parameters, [&] { progress.check(); });
    c.cost = problem.cost(c.parameters);
  });
  return std::min_element(candidates.begin(), candidates.end(), better)->parameters;
}

}  // namespace

GgxParameters fit_ggx(const Material& material, int threads, Progress& progress) {
  const auto source = [&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t>) {
    evaluate(material, wv, wl, f);
  };
  return fit(source, material.isotropic(), threads, progress);
}

GgxParameters fit_ggx(const Measurement& measurement, int threads, Progress& progress) {
  const auto rest = measurement.without_held_out(progress);
  const Measurement& read = rest ? *rest : measurement;
  const auto source = [&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> covered) {
    read.eval(wv, wl, f, covered);
  };
  return fit(source, measurement.isotropic(), threads, progress);
}

GgxFit judge_ggx(const Measurement& measurement, int threads, Progress& progress) {
  progress.stage("ggx fit", 0, 0.5);
  GgxFit out{.parameters = fit_ggx(measurement, threads, progress), .error = {}};
  progress.stage("compare", 0.5, 1);
  out.error = compare(measurement, *make_ggx_material(out.parameters), progress);
  return out;
}

}  // namespace velour
