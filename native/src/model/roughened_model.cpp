#include "model/roughened_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include "base/error.h"
#include "base/parallel.h"
#include "brdf/model/parametric_brdf.h"
#include "image/tensors/tensor.h"
#include "math/srbf/kernel.h"

namespace velour {

namespace {

std::string text_of(float roughness) {
  char text[16];
  std::snprintf(text, sizeof text, "%.3g", static_cast<double>(roughness));
  return text;
}

}  // namespace

Model roughened(const Model& model, float roughness) {
  if (!(roughness >= 0 && roughness <= 1)) {
    refuse("The roughness offset is " + text_of(roughness) + "; it must be 0 to 1.");
  }
  if (roughness == 0) return model;
  if (is_btf(model)) {
    refuse("BTF models do not support a roughness offset. Set the roughness offset to 0, or use a BRDF model.");
  }
  Model rougher = model;
  const auto r = static_cast<double>(roughness);
  if (const auto* per_view = std::get_if<PerViewBrdf>(&model.body)) rougher.body = roughened(*per_view, r);
  if (const auto* parametric = std::get_if<ParametricBrdf>(&model.body)) rougher.body = roughened(*parametric, r);
  rougher.fit.verdict = std::nullopt;  // of the other look
  rougher.fit.warnings.push_back(warning<WarningCode::roughened>({{"roughness", roughness}}));
  return rougher;
}

namespace {

constexpr double kMinNodeCosine = 1e-4, kMinLight = 1e-30;
constexpr int kMaxGridCells = 24;  // twice as many take four times as long

using P = ParametricBrdf;

/// Sets a control value, clamped and rounded as in model files.
void set(ParametricBrdf& brdf, int node, int parameter, int lobe, double value) {
  const ParameterRange range = parameter_range(parameter);
  brdf.control[brdf.index(node, parameter, lobe)] =
      rounded_to_half(std::clamp(static_cast<float>(value), range.least, range.most));
}

double get(const ParametricBrdf& brdf, int node, int parameter, int lobe) {
  return static_cast<double>(brdf.control[brdf.index(node, parameter, lobe)]);
}

/// The same model on a spline with intervals of half the length.
ParametricBrdf halved(const ParametricBrdf& brdf) {
  ParametricBrdf finer = brdf;
  finer.cells = 2 * brdf.cells;
  const ViewSpline spline = brdf.spline();
  finer.control.resize(finer.index(finer.spline().node_count(), 0, 0));
  std::vector<double> values(static_cast<size_t>(spline.node_count()));
  for (int lobe = 0; lobe < brdf.lobe_count(); ++lobe) {
    for (int k = 0; k < brdf.parameter_count(); ++k) {
      for (int node = 0; node < spline.node_count(); ++node) {
        values[static_cast<size_t>(node)] = get(brdf, node, k, lobe);
      }
      const auto finer_values = spline.halved(values, brdf.isotropic && k == P::kTiltX);
      for (size_t node = 0; node < finer_values.size(); ++node) {
        set(finer, static_cast<int>(node), k, lobe, finer_values[node]);
      }
    }
  }
  return finer;
}

/// The same model on a finer spline, since rougher lobes vary with the view in other ways.
ParametricBrdf refined(ParametricBrdf brdf) {
  const int most = brdf.isotropic ? ViewSpline::kMaxCells : kMaxGridCells;
  while (2 * brdf.cells <= most) brdf = halved(brdf);
  return brdf;
}

/// Widens the lobe that a node's control values describe. A spline stays between its control values, so more roughness
/// makes no lobe narrower at any view.
void widen(ParametricBrdf& brdf, int node, int lobe, double by) {
  LobeParameters p{};
  for (int k = 0; k < brdf.parameter_count(); ++k) p[static_cast<size_t>(k)] = get(brdf, node, k, lobe);
  store_shape(widened(lobe_of(p, brdf.space[static_cast<size_t>(lobe)], 1), by), p);
  for (int k = 0; k < brdf.parameter_count(); ++k) {
    if (k < P::kLogRed || k > P::kLogBlue) set(brdf, node, k, lobe, p[static_cast<size_t>(k)]);
  }
}

/// Adds `by` to the log coefficient of a lobe and channel at a node.
void brighten(ParametricBrdf& brdf, int node, int channel, int lobe, double by) {
  const int k = P::kLogRed + channel;
  set(brdf, node, k, lobe, get(brdf, node, k, lobe) + by);
}

/// Light that each lobe reflects at a view, per channel.
std::vector<Vec3d> lights_of(const ParametricBrdf& brdf, const Vec3d& wv) {
  std::vector<Vec3d> light;
  for (const WarpedLobe& lobe : lobes_at(brdf, wv)) light.push_back(lobe.coefficient * reflected_light(lobe, wv));
  return light;
}

double log_of(double light) { return std::log(std::max(light, kMinLight)); }

/// Gives each lobe of `rougher` about the light that it reflects in `brdf`. The factors at the nodes' views are added
/// to the control values, so the factor at a view lies between those of its nodes.
void keep_light_of_lobes(const ParametricBrdf& brdf, ParametricBrdf& rougher) {
  const ViewSpline spline = brdf.spline();
  std::vector<std::vector<double>> change(static_cast<size_t>(spline.node_count()));
  parallel_fill(change.size(), [&](size_t node) {
    const Vec3d wv = direction_of(spline.view_of(static_cast<int>(node)));
    const auto before = lights_of(brdf, wv), after = lights_of(rougher, wv);
    for (size_t j = 0; j < before.size(); ++j) change[node].push_back(log_of(before[j].x) - log_of(after[j].x));
  });
  for (int node = 0; node < spline.node_count(); ++node) {
    for (int lobe = 0; lobe < brdf.lobe_count(); ++lobe) {
      const double by = change[static_cast<size_t>(node)][static_cast<size_t>(lobe)];
      for (int c = 0; c < 3; ++c) brighten(rougher, node, c, lobe, by);
    }
  }
}

/// A view, the nodes that it depends on, and the logarithm of reflected over required light there.
struct Claim {
  ViewTaps taps;
  Vec3d excess;

  double left(const std::vector<double>& change, int c) const {
    double sum = excess[c];
    for (int t = 0; t < taps.count; ++t) sum += taps.weight[t] * change[static_cast<size_t>(taps.node[t])];
    return sum;
  }
};

/// Views of the nodes of a spline with twice as many cells; those at the horizon are raised just above it.
std::vector<Vec3d> claimed_views(const ParametricBrdf& brdf) {
  constexpr double kLast = 1.569;  // radians: a tenth of a degree above the horizon
  const ViewSpline dense = brdf.spline().refined(2);
  std::vector<Vec3d> views;
  for (int node = 0; node < dense.node_count(); ++node) {
    PolarView<double> view = dense.view_of(node);
    view.theta = std::min(view.theta, kLast);
    views.push_back(direction_of(view));
  }
  return views;
}

std::vector<Claim> claims_of(const ParametricBrdf& brdf, const ParametricBrdf& rougher) {
  const std::vector<Vec3d> views = claimed_views(brdf);
  std::vector<Claim> claims(views.size());
  parallel_fill(views.size(), [&](size_t i) {
    Vec3d before(0), after(0);
    for (const Vec3d& light : lights_of(brdf, views[i])) before += light;
    for (const Vec3d& light : lights_of(rougher, views[i])) after += light;
    claims[i].taps = brdf.spline().at(views[i]);
    for (int c = 0; c < 3; ++c) claims[i].excess[c] = log_of(after[c]) - log_of(before[c]);
  });
  return claims;
}

/// Changes of the nodes' log coefficients that cancel the excess of the claims: each round subtracts the mean residual
/// about each node. Finally the largest positive residual at a node is subtracted, so that no claim is exceeded.
std::vector<double> change_of(const std::vector<Claim>& claims, size_t nodes, int c) {
  constexpr int kRounds = 60;
  std::vector<double> change(nodes, 0.0);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> sum(nodes, 0.0), weight(nodes, 1e-9);
    for (const Claim& claim : claims) {
      const double left = claim.left(change, c);
      for (int t = 0; t < claim.taps.count; ++t) {
        const auto node = static_cast<size_t>(claim.taps.node[t]);
        sum[node] += claim.taps.weight[t] * left;
        weight[node] += claim.taps.weight[t];
      }
    }
    for (size_t node = 0; node < nodes; ++node) change[node] -= sum[node] / weight[node];
  }
  std::vector<double> above(nodes, 0.0);
  for (const Claim& claim : claims) {
    const double left = claim.left(change, c);
    for (int t = 0; t < claim.taps.count; ++t) {
      double& most = above[static_cast<size_t>(claim.taps.node[t])];
      most = std::max(most, left);
    }
  }
  for (size_t node = 0; node < nodes; ++node) change[node] -= above[node];
  return change;
}

/// Restores the albedo of all lobes together, per channel.
void keep_albedo(const ParametricBrdf& brdf, ParametricBrdf& rougher) {
  const std::vector<Claim> claims = claims_of(brdf, rougher);
  const int nodes = brdf.spline().node_count();
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> change = change_of(claims, static_cast<size_t>(nodes), c);
    for (int node = 0; node < nodes; ++node) {
      for (int j = 0; j < brdf.lobe_count(); ++j) brighten(rougher, node, c, j, change[static_cast<size_t>(node)]);
    }
  }
}

}  // namespace

ParametricBrdf roughened(const ParametricBrdf& original, double roughness) {
  if (original.lobe_count() == 0) return original;
  const ParametricBrdf brdf = refined(original);
  ParametricBrdf rougher = brdf;
  const ViewSpline spline = brdf.spline();
  for (int node = 0; node < spline.node_count(); ++node) {
    const double cosine = std::max(std::cos(spline.view_of(node).theta), kMinNodeCosine);
    const double of_half = half_bandwidth_of_roughness(roughness);
    const double of_light = light_bandwidth_of_roughness(roughness, cosine);
    for (int lobe = 0; lobe < brdf.lobe_count(); ++lobe) {
      const bool half = brdf.space[static_cast<size_t>(lobe)] == LobeSpace::half;
      widen(rougher, node, lobe, half ? of_half : of_light);
    }
  }
  keep_light_of_lobes(brdf, rougher);
  keep_albedo(brdf, rougher);
  return rougher;
}

namespace {

constexpr float kMinViewCosine = 1e-4f;
constexpr double kMinLobeLight = 1e-30;

/// Roughens a lobe of f cos over light directions.
void roughen(Kernel kernel, double by, float cosine, float& bandwidth, Rgb& coefficient) {
  const auto before = static_cast<double>(bandwidth);
  bandwidth = std::min(bandwidth, static_cast<float>(widened_bandwidth(kernel, before, by)));
  const auto light = [&](double b) { return kernel_integral_above(kernel, b, static_cast<double>(cosine)); };
  coefficient *= static_cast<float>(light(before) / std::max(light(static_cast<double>(bandwidth)), kMinLobeLight));
}

}  // namespace

PerViewBrdf roughened(const PerViewBrdf& brdf, double roughness) {
  PerViewBrdf rougher = brdf;
  for (size_t view = 0; view < brdf.views.size(); ++view) {
    const double cosine = static_cast<double>(std::max(brdf.views[view].z, kMinViewCosine));
    const double by = light_bandwidth_of_roughness(roughness, cosine);
    for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
      roughen(brdf.kernel, by, brdf.center[j].z, rougher.bandwidth[j], rougher.coefficient[j]);
    }
  }
  return rougher;
}

namespace {

/// Finds the narrowest of the lobes at one view.
class NarrowestLobe {
 public:
  /// `bandwidth`: over half vectors, along the narrowest axis. `light`: what the lobe reflects.
  void add(double bandwidth, double light) {
    lobes_.push_back({bandwidth, light});
    total_ += light;
  }
  double roughness() const {
    constexpr double kNoticeable = 0.01;
    double most = 0;
    for (const auto& [bandwidth, light] : lobes_) {
      if (light >= kNoticeable * total_) most = std::max(most, bandwidth);
    }
    return most > 0 ? std::min(std::pow(2 / most, 0.25), 1.0) : 1.0;
  }

 private:
  struct Lobe {
    double bandwidth, light;
  };
  std::vector<Lobe> lobes_;
  double total_ = 0;
};

}  // namespace

double narrowest_roughness(const ParametricBrdf& brdf) {
  double narrowest = 1;
  for (const double theta : {0.1, 0.7, 1.2}) {
    const Vec3d wv(std::sin(theta), 0, std::cos(theta));
    NarrowestLobe lobes;
    for (const WarpedLobe& lobe : lobes_at(brdf, wv)) {
      const double stretched = lobe.bandwidth * std::exp(2 * glm::length(exponents_of(lobe.stretch)));
      const double light = (lobe.coefficient.x + lobe.coefficient.y + lobe.coefficient.z) * reflected_light(lobe, wv);
      lobes.add(lobe.space == LobeSpace::half ? stretched : 4 * wv.z * stretched, light);
    }
    narrowest = std::min(narrowest, lobes.roughness());
  }
  return narrowest;
}

double narrowest_roughness(const PerViewBrdf& brdf) {
  double narrowest = 1;
  for (size_t view = 0; view < brdf.views.size(); ++view) {
    NarrowestLobe lobes;
    for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
      const auto bandwidth = static_cast<double>(brdf.bandwidth[j]);
      const Rgb c = brdf.coefficient[j];
      const double light = static_cast<double>(c.r + c.g + c.b) * kernel_integral(brdf.kernel, bandwidth);
      // The Gaussian kernel of the same mean cosine.
      const double gaussian = brdf.kernel == Kernel::gaussian ? bandwidth : gaussian_bandwidth_of_mean(1 - bandwidth);
      lobes.add(4 * static_cast<double>(std::max(brdf.views[view].z, kMinViewCosine)) * gaussian, light);
    }
    narrowest = std::min(narrowest, lobes.roughness());
  }
  return narrowest;
}

}  // namespace velour
