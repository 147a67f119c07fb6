#include "brdf/fit/ggx_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/slice_sampling.h"
#include "material/microfacet/ggx.h"
#include "math/optimize/nnls.h"

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

namespace {

/// The unknowns of one channel, in the order of Basis.
Vec3 unknowns(const GgxParameters& p, int c) { return {p.diffuse[c], p.f0[c], p.f90[c]}; }

void set_unknowns(GgxParameters& p, int c, const Vec3& value) {
  p.diffuse[c] = value.x;
  p.f0[c] = value.y;
  p.f90[c] = value.z;
}

}  // namespace

GgxProblem::GgxProblem(PairSamples samples, bool isotropic)
    : samples_(std::move(samples.samples)), floor_(samples.floor), isotropic_(isotropic) {
  for (const PairSample& s : samples_) {
    const Vec3 h = glm::normalize(s.w.wl + s.w.wv);
    geometry_.push_back({h, schlick_share(std::min(glm::dot(s.w.wv, h), 1.0f))});
  }
}

GgxProblem::Basis GgxProblem::basis(size_t i, const Vec2& alpha) const {
  const PairSample& s = samples_[i];
  const float lobe = ggx_brdf_without_fresnel(s.w, geometry_[i].h, alpha) * s.w.wl.z;
  return {s.w.wl.z / kPi, (1 - geometry_[i].schlick) * lobe, geometry_[i].schlick * lobe};
}

double GgxProblem::cost(const GgxParameters& p) const {
  double sum = 0;
  for (size_t i = 0; i < samples_.size(); ++i) {
    const Basis b = basis(i, p.alpha);
    const Rgb model = b.base * p.diffuse + b.normal * p.f0 + b.grazing * p.f90;
    const Rgb difference = glm::sqrt(model + floor_) - glm::sqrt(samples_[i].f_cos + floor_);
    sum += samples_[i].weight * glm::dot(difference, difference);
  }
  return sum;
}

GgxParameters GgxProblem::completed(const GgxParameters& start) const {
  Eigen::Matrix3d gram[3];
  Eigen::Vector3d moment[3];
  for (int c = 0; c < 3; ++c) gram[c].setZero(), moment[c].setZero();
  for (size_t i = 0; i < samples_.size(); ++i) {
    const Basis b = basis(i, start.alpha);
    const Eigen::Vector3d row(b.base, b.normal, b.grazing);
    for (int c = 0; c < 3; ++c) {
      const double y = samples_[i].f_cos[c], weight = samples_[i].weight / (y + floor_);  // g'(y)^2 up to a factor
      gram[c].noalias() += weight * row * row.transpose();
      moment[c].noalias() += weight * y * row;
    }
  }
  GgxParameters p{.alpha = start.alpha};
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
    solve_nnls(gram[c], moment[c], 1e-9, x);
    set_unknowns(p, c, {x[0], x[1], x[2]});
  }
  return p;
}

GgxProblem::Normal GgxProblem::normal(const GgxParameters& p) const {
  const int shared = alphas(), size = shared + 9;
  Normal n(size);
  for (size_t i = 0; i < samples_.size(); ++i) {
    const PairSample& s = samples_[i];
    const Basis b = basis(i, p.alpha);
    const Vec2 both = ggx_log_slope(s.w, geometry_[i].h, p.alpha);
    const Vec2 slope = isotropic_ ? Vec2(both.x + both.y, 0) : both;
    for (int c = 0; c < 3; ++c) {
      const float lobe = b.normal * p.f0[c] + b.grazing * p.f90[c];
      const float root = std::sqrt(b.base * p.diffuse[c] + lobe + floor_);
      const double residual = static_cast<double>(root) - std::sqrt(s.f_cos[c] + floor_);
      const Eigen::Matrix<double, 5, 1> row =
          0.5 / root * Eigen::Matrix<double, 5, 1>(lobe * slope.x, lobe * slope.y, b.base, b.normal, b.grazing).eval();
      const int at = shared + 3 * c;
      const Eigen::Matrix<double, 5, 1> weighted = s.weight * row;
      n.curvature.topLeftCorner(shared, shared).noalias() += weighted.head(shared) * row.head(shared).transpose();
      n.curvature.block(at, 0, 3, shared).noalias() += weighted.tail<3>() * row.head(shared).transpose();
      n.curvature.block<3, 3>(at, at).noalias() += weighted.tail<3>() * row.tail<3>().transpose();
      n.slope.head(shared).noalias() += residual * weighted.head(shared);
      n.slope.segment<3>(at).noalias() += residual * weighted.tail<3>();
    }
  }
  n.curvature = n.curvature.selfadjointView<Eigen::Lower>();
  freeze_at_zero(p, n);
  return n;
}

/// Excludes reflectances of 0 that would become negative from this step.
void GgxProblem::freeze_at_zero(const GgxParameters& p, Normal& n) const {
  for (int c = 0; c < 3; ++c) {
    const Vec3 now = unknowns(p, c);
    for (int k = 0; k < 3; ++k) {
      const int at = alphas() + 3 * c + k;
      if (now[k] > 0 || n.slope[at] < 0) continue;
      n.freeze(at);
    }
  }
}

GgxParameters GgxProblem::moved(const GgxParameters& p, const decltype(Normal::slope)& step) const {
  GgxParameters to = p;
  for (int k = 0; k < 2; ++k) {
    const double by = std::clamp(step[isotropic_ ? 0 : k], -1.0, 1.0);  // the linear model holds no further
    to.alpha[k] = std::clamp(p.alpha[k] * static_cast<float>(std::exp(by)), kMinGgxAlpha, kLargestAlpha);
  }
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3f by = step.segment<3>(alphas() + 3 * c).cast<float>();
    set_unknowns(to, c, glm::max(unknowns(p, c) + Vec3(by[0], by[1], by[2]), Vec3(0)));
  }
  return to;
}

}  // namespace velour
