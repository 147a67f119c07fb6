#include "brdf/fit/pair_samples.h"

#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/view_grid.h"

namespace velour {
namespace {

/// f of each wl for one view; `covered` is 1 everywhere on entry.
using Source =
    std::function<void(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> covered)>;

constexpr int kPairRings = 32, kPairSpokes = 16;
constexpr float kSampleFloor = 1e-3f;  // relative to the mean f cos

/// Views in the middles of 5-degree intervals, as far from the held-out views as possible.
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

/// The samples of one view; none if it is black.
std::vector<PairSample> samples_of(const Source& source, const Vec3& wv) {
  LightGrid grid = light_grid(wv, kPairRings, kPairSpokes);
  std::vector<Rgb> f(grid.wl.size());
  std::vector<uint8_t> covered(grid.wl.size(), 1);
  source(wv, grid.wl, f, covered);
  redistribute_weights(grid, covered);
  std::vector<PairSample> samples;
  double albedo = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    if (!covered[i]) continue;
    const Rgb f_cos = glm::max(f[i], Rgb(0)) * grid.wl[i].z;
    samples.push_back({{.wl = grid.wl[i], .wv = wv}, f_cos, grid.weight[i]});
    albedo += grid.weight[i] * luminance(f_cos);
  }
  if (!(albedo > 0)) return {};
  const float sin_2_theta = wv.z * std::sqrt(wv.x * wv.x + wv.y * wv.y);
  for (PairSample& s : samples) s.weight *= sin_2_theta / static_cast<float>(albedo);
  return samples;
}

float mean_of(std::span<const PairSample> samples) {
  double sum = 0, weights = 0;
  for (const PairSample& s : samples) {
    sum += s.weight * luminance(s.f_cos);
    weights += s.weight;
  }
  return weights > 0 ? static_cast<float>(sum / weights) : 0;
}

PairSamples all_samples(const Source& source, bool isotropic, int threads, Progress& progress) {
  const std::vector<Vec3> views = views_of(isotropic);
  std::vector<std::vector<PairSample>> of_view(views.size());
  parallel_for_each(views.size(), threads, progress, [&](size_t i) { of_view[i] = samples_of(source, views[i]); });
  PairSamples all;
  for (const auto& some : of_view) all.samples.insert(all.samples.end(), some.begin(), some.end());
  all.floor = kSampleFloor * mean_of(all.samples);
  if (!(all.floor > 0)) all.samples.clear();
  return all;
}

}  // namespace

PairSamples pair_samples(const Material& material, int threads, Progress& progress) {
  const auto source = [&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t>) {
    evaluate(material, wv, wl, f);
  };
  return all_samples(source, material.isotropic(), threads, progress);
}

PairSamples pair_samples(const Measurement& measurement, int threads, Progress& progress) {
  const auto rest = measurement.without_held_out(progress);
  const Measurement& read = rest ? *rest : measurement;
  const auto source = [&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> covered) {
    read.eval(wv, wl, f, covered);
  };
  return all_samples(source, measurement.isotropic(), threads, progress);
}

}  // namespace velour
