#include "usage/picture_error.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "brdf/model/parametric_brdf.h"
#include "image/picture.h"

namespace velour {
namespace {

/// f of a model at one view.
class Slice {
 public:
  Slice(const ParametricBrdf& brdf, const Vec3& wv) : brdf_(brdf), wv_(wv), lobes_(lobes_at(brdf, wv_)) {}

  Vec3d operator()(const Vec3& wl) const {
    return brdf_.symmetric ? value_of(brdf_, Vec3d(wl), wv_) : value_of(lobes_, Vec3d(wl), wv_);
  }

 private:
  const ParametricBrdf& brdf_;
  Vec3d wv_;
  std::vector<WarpedLobe> lobes_;
};

/// f of the measurement at a hit's terms, clamped at 0 as in rendering; f of `stand_in` for pairs it does not cover.
void measure_hit(const Measurement& measurement, const ParametricBrdf& stand_in, const ObservedHit& hit,
                 std::span<const Vec3> wl, Vec3d* out) {
  std::vector<Rgb> f(wl.size());
  std::vector<uint8_t> valid(wl.size());
  measurement.eval(hit.wv, wl, f, valid);
  const Slice slice(stand_in, hit.wv);
  for (size_t i = 0; i < wl.size(); ++i) out[i] = valid[i] ? Vec3d(glm::max(f[i], Rgb(0))) : slice(wl[i]);
}

/// Reflected radiance of each lobe at one hit, for each half of its light, and the error of their sum.
struct HitSlopes {
  ViewTaps taps;
  std::vector<Vec3d> lobe[2];
  Vec3d error[2] = {Vec3d(0), Vec3d(0)};
};

HitSlopes hit_slopes(const SceneObservation& observation, const ObservedHit& hit, const ParametricBrdf& model,
                     const std::vector<Vec3d>& measured) {
  const std::vector<WarpedLobe> lobes = lobes_at(model, Vec3d(hit.wv));
  HitSlopes out;
  out.taps = model.spline().at(Vec3d(hit.wv));
  for (auto& half : out.lobe) half.assign(lobes.size(), Vec3d(0));
  for (uint32_t i = hit.first; i < hit.last; ++i) {
    const int half = i < hit.middle ? 0 : 1;
    const Vec3d light(observation.light[i]);
    out.error[half] -= light * measured[i];
    for (size_t j = 0; j < lobes.size(); ++j) {
      const Vec3d sent =
          light * lobes[j].coefficient * warped_kernel(lobes[j], Vec3d(observation.wl[i]), Vec3d(hit.wv));
      out.lobe[half][j] += sent;
      out.error[half] += sent;
    }
  }
  return out;
}

/// Normal equations of one channel in the logarithms of its coefficients, [node][lobe].
class ColorNormal {
 public:
  explicit ColorNormal(size_t unknowns)
      : matrix_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(unknowns), static_cast<Eigen::Index>(unknowns))),
        gradient_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns))) {}

  void add(const HitSlopes& hit, size_t lobes, int c, double scale) {
    // Slopes by log coefficient: of the mean of both halves, and of each half times the error of the other.
    const auto count = static_cast<Eigen::Index>(hit.taps.count) * static_cast<Eigen::Index>(lobes);
    Eigen::VectorXd both(count), crossed(count);
    std::vector<Eigen::Index> place;
    for (int t = 0; t < hit.taps.count; ++t) {
      for (size_t j = 0; j < lobes; ++j) {
        const auto row = static_cast<Eigen::Index>(place.size());
        const double weight = hit.taps.weight[t], a = hit.lobe[0][j][c], b = hit.lobe[1][j][c];
        both[row] = 0.5 * weight * (a + b);
        crossed[row] = 0.5 * weight * (a * hit.error[1][c] + b * hit.error[0][c]);
        place.push_back(static_cast<Eigen::Index>(static_cast<size_t>(hit.taps.node[t]) * lobes + j));
      }
    }
    for (Eigen::Index r = 0; r < count; ++r) {
      gradient_[place[static_cast<size_t>(r)]] += scale * crossed[r];
      for (Eigen::Index s = 0; s < count; ++s) {
        matrix_(place[static_cast<size_t>(r)], place[static_cast<size_t>(s)]) += scale * both[r] * both[s];
      }
    }
  }

  /// `ridge` is relative to the mean diagonal.
  Eigen::VectorXd solve(double ridge) const {
    const double mean = matrix_.trace() / static_cast<double>(std::max<Eigen::Index>(matrix_.rows(), 1));
    Eigen::MatrixXd held = matrix_;
    held.diagonal().array() += ridge * mean + 1e-30;
    return -held.ldlt().solve(gradient_).cwiseMax(-1.0).cwiseMin(1.0);
  }

 private:
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_;
};

}  // namespace

PictureError::PictureError(const Measurement& measurement, const ParametricBrdf& stand_in,
                           const SceneObservation& observation, int threads, const Progress& progress)
    : observation_(observation), threads_(threads), progress_(progress), measured_(observation.wl.size()) {
  const auto& hits = observation.hits;
  std::vector<Vec3d> radiance(hits.size(), Vec3d(0));
  parallel_pieces(hits.size(), threads, progress, [&](size_t h) {
    const ObservedHit& hit = hits[h];
    const std::span<const Vec3> wl(observation.wl.data() + hit.first, hit.last - hit.first);
    measure_hit(measurement, stand_in, hit, wl, measured_.data() + hit.first);
    for (uint32_t i = hit.first; i < hit.last; ++i) radiance[h] += 0.5 * measured_[i] * Vec3d(observation.light[i]);
  });
  Vec3d mean(0);
  for (const Vec3d& r : radiance) mean += r / static_cast<double>(radiance.size());
  const Vec3d floor(relmse_floor(mean.x), relmse_floor(mean.y), relmse_floor(mean.z));
  for (const Vec3d& r : radiance) scale_.push_back(1.0 / (3.0 * (r * r + floor)));
}

std::vector<size_t> PictureError::hits_of(Part part) const {
  std::vector<size_t> out;
  for (size_t h = static_cast<size_t>(part); h < observation_.hits.size(); h += 2) out.push_back(h);
  return out;
}

std::vector<double> PictureError::shares(const ParametricBrdf& model, Part part) const {
  const std::vector<size_t> hits = hits_of(part);
  std::vector<double> out(hits.size());
  parallel_pieces(out.size(), threads_, progress_, [&](size_t i) {
    const size_t h = hits[i];
    const ObservedHit& hit = observation_.hits[h];
    const Slice slice(model, hit.wv);
    Vec3d error[2] = {Vec3d(0), Vec3d(0)};
    for (uint32_t k = hit.first; k < hit.last; ++k) {
      const Vec3d difference = slice(observation_.wl[k]) - measured_[k];
      error[k < hit.middle ? 0 : 1] += difference * Vec3d(observation_.light[k]);
    }
    out[i] = glm::dot(error[0] * error[1], scale_[h]);
  });
  return out;
}

void PictureError::refine_colors(ParametricBrdf& model) const {
  constexpr int kSteps = 3;
  constexpr double kRidges[] = {1e-4, 1e-2, 1};  // relative to the mean diagonal
  double error = estimate(shares(model, Part::refined)).relmse;
  for (int i = 0; i < kSteps; ++i) {
    bool better = false;
    for (const double ridge : kRidges) {
      ParametricBrdf trial = model;
      step_colors(trial, ridge);
      const double trial_error = estimate(shares(trial, Part::refined)).relmse;
      better = trial_error < error;
      if (!better) continue;
      error = trial_error;
      model = std::move(trial);
      break;
    }
    if (!better) return;
  }
}

void PictureError::step_colors(ParametricBrdf& model, double ridge) const {
  using P = ParametricBrdf;
  const auto lobe_count = static_cast<size_t>(model.lobe_count());
  const std::vector<size_t> hits = hits_of(Part::refined);
  std::vector<HitSlopes> slopes(hits.size());
  parallel_pieces(slopes.size(), threads_, progress_, [&](size_t i) {
    slopes[i] = hit_slopes(observation_, observation_.hits[hits[i]], model, measured_);
  });
  const auto nodes = static_cast<size_t>(model.spline().node_count());
  for (int c = 0; c < 3; ++c) {
    ColorNormal normal(nodes * lobe_count);
    for (size_t i = 0; i < slopes.size(); ++i) normal.add(slopes[i], lobe_count, c, scale_[hits[i]][c]);
    const Eigen::VectorXd step = normal.solve(ridge);
    for (size_t k = 0; k < nodes; ++k) {
      for (size_t j = 0; j < lobe_count; ++j) {
        const int parameter = P::kLogRed + c;
        const ParameterRange range = parameter_range(parameter);
        float& value = model.control[model.index(static_cast<int>(k), parameter, static_cast<int>(j))];
        const auto moved = value + static_cast<float>(step[static_cast<Eigen::Index>(k * lobe_count + j)]);
        value = glm::unpackHalf1x16(glm::packHalf1x16(std::clamp(moved, range.least, range.most)));
      }
    }
  }
}

PictureErrorEstimate PictureError::estimate(const std::vector<double>& shares) {
  const auto n = static_cast<double>(shares.size());
  double sum = 0, squares = 0;
  for (const double s : shares) sum += s, squares += s * s;
  const double mean = sum / std::max(n, 1.0);
  return {mean, std::sqrt(std::max(squares / std::max(n, 1.0) - mean * mean, 0.0) / std::max(n - 1, 1.0))};
}

}  // namespace velour
