#include "brdf/fit/error/evaluate.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "brdf/eval/parametric_material.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/measure/held_out.h"
#include "brdf/model/parametric_brdf.h"

namespace velour {

void evaluate(const Material& material, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
              std::span<float> density) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  DirectionBatch batch;
  RgbBatch values;
  ScalarBatch pdf;
  for (size_t begin = 0; begin < wl.size(); begin += DirectionBatch::kCapacity) {
    const size_t end = std::min(begin + DirectionBatch::kCapacity, wl.size());
    batch.count = 0;
    for (size_t i = begin; i < end; ++i) batch.push(wl[i]);
    batch.pad();
    point->eval(batch, values, pdf);
    for (size_t i = begin; i < end && !f.empty(); ++i) f[i] = values.get(static_cast<int>(i - begin));
    if (!density.empty()) std::copy_n(pdf.v, end - begin, density.data() + begin);
  }
}

std::vector<Vec3> reported_views(int degrees, bool isotropic) {
  std::vector<Vec3> views;
  for (int azimuth = 0; azimuth < (isotropic ? 1 : 8); ++azimuth) {
    views.push_back(direction(radians_from(static_cast<float>(degrees)), kPi / 4 * static_cast<float>(azimuth)));
  }
  return views;
}

int reported_view_of(const Vec3& wv) {
  const double theta = std::acos(std::clamp(static_cast<double>(wv.z), -1.0, 1.0)) * 180 / kPiD;
  const auto nearest = std::min_element(kHeldOutViews.begin(), kHeldOutViews.end(),
                                        [theta](int a, int b) { return std::abs(theta - a) < std::abs(theta - b); });
  return std::abs(theta - *nearest) <= kHeldOutGroup ? *nearest : -1;
}

MaterialMeasurement::MaterialMeasurement(std::shared_ptr<const Material> material, const ViewRange& views)
    : material_(std::move(material)), views_(views) {}

void MaterialMeasurement::eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
                               std::span<uint8_t> valid) const {
  if (!(wv.z > 0)) {
    std::fill(f.begin(), f.end(), Rgb(0));
    std::fill(valid.begin(), valid.end(), uint8_t{0});
    return;
  }
  evaluate(*material_, wv, wl, f);
  for (size_t i = 0; i < wl.size(); ++i) {
    valid[i] = wl[i].z > 0;
    if (!valid[i]) f[i] = Rgb(0);
  }
}

bool MaterialMeasurement::covers_view(float theta_v) const { return views_.holds(theta_v); }

Vec3d directional_albedo(const Material& material, const Vec3& wv) {
  const LightGrid grid = light_grid(wv);
  std::vector<Rgb> f(grid.wl.size());
  evaluate(material, wv, grid.wl, f);
  Vec3d albedo(0);
  for (size_t i = 0; i < f.size(); ++i) albedo += Vec3d(f[i]) * static_cast<double>(grid.weight[i] * grid.wl[i].z);
  return albedo;
}

MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv) {
  const LightGrid grid = light_grid(wv);
  std::vector<Rgb> f(grid.wl.size());
  std::vector<uint8_t> valid(grid.wl.size());
  measurement.eval(wv, grid.wl, f, valid);
  MeasuredAlbedo out;
  double all = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const double weight = static_cast<double>(grid.weight[i] * grid.wl[i].z);
    all += weight;
    if (!valid[i]) continue;
    out.albedo += Vec3d(f[i]) * weight;
    out.covered += weight;
  }
  if (all > 0) out.covered /= all;
  return out;
}

namespace {

// Target albedo. The margin below 1 covers rounding to half floats and views between the evaluated ones.
constexpr double kGoal = 0.997;
// Maximum number of rounds. Each evaluates the albedo and brings every view to the target, to first order.
constexpr int kLimitRounds = 20;
constexpr int kSweeps = 400;

std::vector<Vec3> limited_views(const ParametricBrdf& brdf) {
  std::vector<Vec3> out;
  constexpr float kStep = 0.5f;
  const auto first = static_cast<float>(brdf.views.begin), last = static_cast<float>(brdf.views.end);
  for (float degrees = first; degrees < last; degrees += kStep) {
    const float theta = radians_from(std::min(degrees, 89.9f));
    const int azimuths = brdf.isotropic || degrees == 0 ? 1 : 16;
    for (int i = 0; i < azimuths; ++i) {
      out.push_back(direction(theta, 2 * kPi * static_cast<float>(i) / static_cast<float>(azimuths)));
    }
  }
  return out;
}

/// Constraint of one view on the log coefficients of a channel: their change at the view must be at most -`excess`.
struct Claim {
  ViewTaps taps;
  double excess;
};

/// Changes of the node values that satisfy all constraints, by cyclic projection: close to the smallest such change.
std::vector<double> change_of(const std::vector<Claim>& claims, size_t nodes) {
  std::vector<double> change(nodes, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double worst = 0;
    for (const Claim& claim : claims) {
      double there = 0, square = 0;
      for (int t = 0; t < claim.taps.count; ++t) {
        there += claim.taps.weight[t] * change[static_cast<size_t>(claim.taps.node[t])];
        square += claim.taps.weight[t] * claim.taps.weight[t];
      }
      const double missing = there + claim.excess;
      worst = std::max(worst, missing);
      if (missing <= 0) continue;
      for (int t = 0; t < claim.taps.count; ++t) {
        change[static_cast<size_t>(claim.taps.node[t])] -= missing * claim.taps.weight[t] / square;
      }
    }
    if (worst < 1e-5) break;
  }
  return change;
}

void move_channel(ParametricBrdf& brdf, int c, const std::vector<double>& change) {
  const int parameter = ParametricBrdf::kLogRed + c;
  const ParameterRange range = parameter_range(parameter);
  for (size_t node = 0; node < change.size(); ++node) {
    if (change[node] == 0) continue;
    for (int j = 0; j < brdf.lobe_count(); ++j) {
      float& value = brdf.control[brdf.index(static_cast<int>(node), parameter, j)];
      const float moved = std::max(value + static_cast<float>(change[node]), range.least);
      value = glm::unpackHalf1x16(glm::packHalf1x16(moved));
    }
  }
}

std::vector<Vec3d> albedos(const ParametricBrdf& brdf, const std::vector<Vec3>& views, int threads,
                           const Progress& progress) {
  const auto material = make_parametric_material(std::make_shared<const ParametricBrdf>(brdf));
  std::vector<Vec3d> out(views.size());
  parallel_pieces(views.size(), threads, progress, [&](size_t i) { out[i] = directional_albedo(*material, views[i]); });
  return out;
}

}  // namespace

bool limit_albedo(ParametricBrdf& brdf, int threads, const Progress& progress) {
  const std::vector<Vec3> views = limited_views(brdf);
  const auto nodes = static_cast<size_t>(brdf.spline().node_count());
  bool changed = false;
  for (int round = 0; round < kLimitRounds; ++round) {
    const std::vector<Vec3d> albedo = albedos(brdf, views, threads, progress);
    bool above = false;
    for (int c = 0; c < 3; ++c) {
      std::vector<Claim> claims;
      for (size_t i = 0; i < views.size(); ++i) {
        if (albedo[i][c] <= 1) continue;
        claims.push_back({brdf.spline().at(Vec3d(views[i])), std::log(albedo[i][c] / kGoal)});
      }
      if (!claims.empty()) move_channel(brdf, c, change_of(claims, nodes));
      above |= !claims.empty();
    }
    if (!above) return changed;
    changed = true;
  }
  return changed;
}

}  // namespace velour
