#include "brdf/fit/closures/closures.h"

#include <algorithm>
#include <cmath>
#include <Eigen/LU>

namespace velour {

float lowest_closure_tilt(float theta_v) {
  constexpr float kMinRise = 0.01f;
  const float rise = std::min(0.9f * std::cos(theta_v), kMinRise);
  return 0.5f * (theta_v - std::acos(std::clamp(rise, 0.0f, 1.0f)));
}

namespace {

/// Value of a curve at theta_v, held at the ends.
template <class T>
T closure_value(const ClosureCurve<T>& curve, float theta_v) {
  const float at = std::clamp(theta_v / (0.5f * kPi), 0.0f, 1.0f) * (kClosureSamples - 1);
  const size_t i = std::min(static_cast<size_t>(at), static_cast<size_t>(kClosureSamples - 2));
  const float t = at - static_cast<float>(i);
  return curve[i] * (1 - t) + curve[i + 1] * t;
}

ClosureLobeShape shape_at(const ClosureLobe& lobe, LobeMasking masking, float theta_v) {
  const float roughness = closure_value(lobe.roughness, theta_v), alpha = roughness * roughness;
  const float stretch = std::exp(closure_value(lobe.anisotropy, theta_v));
  return {.distribution = lobe.distribution,
          .masking = masking,
          .alpha_x = std::min(alpha * stretch, 1.0f),
          .alpha_y = std::min(alpha / stretch, 1.0f),
          .tilt = closure_value(lobe.tilt, theta_v) * theta_v};
}

}  // namespace

AlignedArray<float> closure_values(const ClosureNetwork& network, LobeMasking masking, const ClosureLights& lights) {
  const size_t row = lights.padded();
  AlignedArray<float> values(3 * row), lobe(row);
  const auto color_at = [&](const ClosureCurve<Rgb>& curve) { return closure_value(curve, lights.theta_v()); };
  const Rgb diffuse = color_at(network.diffuse) / kPi;
  for (int c = 0; c < 3; ++c) {
    float* out = values.data() + static_cast<size_t>(c) * row;
    for (size_t i = 0; i < row; ++i) out[i] = diffuse[c] * lights.wl_z()[i] * lights.root_weight()[i];
  }
  for (const ClosureLobe& l : network.lobes) {
    fill_lobe(lights, shape_at(l, masking, lights.theta_v()), lobe.data());
    const Rgb weight = color_at(l.weight);
    for (int c = 0; c < 3; ++c) {
      float* out = values.data() + static_cast<size_t>(c) * row;
      for (size_t i = 0; i < row; ++i) out[i] += weight[c] * lobe.data()[i];
    }
  }
  return values;
}

float incoming_factor(float tilt, float theta_v) {
  if (theta_v < 1e-3f) return tilt;
  const float across = std::tan(tilt * theta_v);
  return across / (std::sin(theta_v) + across * (1 - std::cos(theta_v)));
}

float anisotropy_input(float anisotropy) {
  return anisotropy < 0 ? 1 - std::exp(anisotropy) : std::exp(-anisotropy) - 1;
}

std::array<double, kClosureKnots> closure_knots() {
  std::array<double, kClosureKnots> knots{0, 12, 25, 38, 50, 61, 70, 78, 84, 89};
  for (double& k : knots) k = radians_from(k);
  return knots;
}

namespace {

using KnotMatrix = Eigen::Matrix<double, kClosureKnots, kClosureKnots>;

/// Second derivatives of the spline at the knots, as factors of its values.
KnotMatrix knot_curvatures(const std::array<double, kClosureKnots>& x) {
  KnotMatrix left = KnotMatrix::Zero(), right = KnotMatrix::Zero();
  const auto add_slope = [&](int row, int i, double sign) {  // slope of the chord after knot i
    const double h = x[static_cast<size_t>(i) + 1] - x[static_cast<size_t>(i)];
    right(row, i + 1) += sign * 6 / h;
    right(row, i) -= sign * 6 / h;
  };
  const auto width = [&](int i) { return x[static_cast<size_t>(i) + 1] - x[static_cast<size_t>(i)]; };
  left(0, 0) = 2 * width(0);
  left(0, 1) = width(0);
  add_slope(0, 0, 1);
  for (int i = 1; i + 1 < kClosureKnots; ++i) {
    left(i, i - 1) = width(i - 1);
    left(i, i) = 2 * (width(i - 1) + width(i));
    left(i, i + 1) = width(i);
    add_slope(i, i, 1);
    add_slope(i, i - 1, -1);
  }
  left(kClosureKnots - 1, kClosureKnots - 1) = 1;
  return left.partialPivLu().solve(right);
}

}  // namespace

Eigen::Matrix<double, kClosureKnots, 1> closure_taps(double theta_v) {
  const auto x = closure_knots();
  const KnotMatrix curvature = knot_curvatures(x);
  const double theta = std::clamp(theta_v, x.front(), x.back());
  int i = 0;
  while (i + 2 < kClosureKnots && theta > x[static_cast<size_t>(i) + 1]) ++i;
  const double h = x[static_cast<size_t>(i) + 1] - x[static_cast<size_t>(i)];
  const double b = (theta - x[static_cast<size_t>(i)]) / h, a = 1 - b;
  Eigen::Matrix<double, kClosureKnots, 1> taps =
      h * h / 6 * ((a * a * a - a) * curvature.row(i) + (b * b * b - b) * curvature.row(i + 1)).transpose();
  taps[i] += a;
  taps[i + 1] += b;
  return taps;
}

namespace {

/// Polar angle of the view (radians) below which anisotropy fades to 0: the plane of incidence has no direction at the
/// normal.
constexpr double kAnisotropyFade = radians_from(4.0);

double anisotropy_share(double theta_v, ClosureFrame frame) {
  if (frame == ClosureFrame::surface) return 1;
  const double t = std::min(theta_v / kAnisotropyFade, 1.0);
  return t * t * (3 - 2 * t);
}

/// |anisotropy| is below the lesser of a maximum and of depth = -log(alpha), made smooth.
struct AnisotropyBound {
  AnisotropyBound(double depth, ClosureFrame frame) {
    const double most = frame == ClosureFrame::surface ? 2.0 : 1.2;
    const double norm = std::pow(most, 4) + std::pow(depth, 4), root = std::pow(norm, -0.25);
    value = most * depth * root;
    by_depth = root * most * (1 - std::pow(depth, 4) / norm);
  }

  double value, by_depth;
};

/// Largest tilt away from the viewer, relative to theta_v, in (0, 1].
double largest_lean(double theta_v) {
  constexpr double kLeast = 1e-4;
  if (theta_v < 0.01) return 1;
  const double angle = std::min(theta_v, closure_knots().back());
  return std::clamp(-static_cast<double>(lowest_closure_tilt(static_cast<float>(angle))) / angle, kLeast, 1.0);
}

}  // namespace

ClosureShape closure_shape(double alpha_unknown, double tilt_unknown, double anisotropy_unknown, double theta_v,
                           const ClosureBounds& bounds, LobeDistribution distribution) {
  ClosureShape s{};
  const double lowest = std::log(bounds.min_alpha), share = 1 / (1 + std::exp(-alpha_unknown));
  const double depth = -lowest * (1 - share);  // -log(alpha)
  s.alpha = std::exp(-depth);
  s.log_alpha_by_alpha = -lowest * share * (1 - share);

  if (bounds.frame == ClosureFrame::incidence) {
    // From -lean to 1, through 0 at 0; tanh if lean is 1.
    const double lean = largest_lean(theta_v), e = std::exp(std::clamp(2 * tilt_unknown, -60.0, 60.0));
    const double below = lean * e + 1;
    s.tilt = lean * (e - 1) / below;
    s.tilt_by_tilt = 2 * e * lean * (1 + lean) / (below * below);
  }

  if (distribution == LobeDistribution::beckmann && !bounds.stretched_beckmann) return s;
  const AnisotropyBound bound(depth, bounds.frame);
  const double share_of_view = anisotropy_share(theta_v, bounds.frame), turn = std::tanh(anisotropy_unknown);
  s.anisotropy = share_of_view * bound.value * turn;
  s.anisotropy_by_alpha = -share_of_view * bound.by_depth * turn * s.log_alpha_by_alpha;
  s.anisotropy_by_anisotropy = share_of_view * bound.value * (1 - turn * turn);
  return s;
}

std::array<LobeDistribution, 2> closure_distributions(const ClosureBounds& bounds) {
  const bool stretches = bounds.stretched_beckmann || bounds.frame == ClosureFrame::incidence;
  return {LobeDistribution::ggx, stretches ? LobeDistribution::beckmann : LobeDistribution::ashikhmin_shirley};
}

double closure_alpha_unknown(double alpha, const ClosureBounds& bounds) {
  const double share = 1 - std::log(alpha) / std::log(bounds.min_alpha), inside = std::clamp(share, 0.02, 0.98);
  return std::log(inside / (1 - inside));
}

double closure_anisotropy_unknown(double anisotropy, double alpha_unknown, const ClosureBounds& bounds) {
  const double depth = -std::log(closure_shape(alpha_unknown, 0, 0, 0, bounds).alpha);
  return std::atanh(std::clamp(anisotropy / AnisotropyBound(depth, bounds.frame).value, -0.95, 0.95));
}

double closure_tilt_unknown(double tilt, double theta_v) {
  const double lean = largest_lean(theta_v), inside = std::clamp(tilt, -0.95 * lean, 0.98);
  return 0.5 * std::log((inside + lean) / (lean * (1 - inside)));
}

ClosureNetwork closure_network(const ClosureUnknowns& unknowns, const std::vector<LobeDistribution>& distributions,
                               const ClosureBounds& bounds) {
  ClosureNetwork network;
  network.frame = bounds.frame;
  for (const LobeDistribution d : distributions) network.lobes.push_back({.distribution = d});
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const double theta = 0.5 * kPiD * static_cast<double>(i) / (kClosureSamples - 1);
    const ViewUnknowns u = unknowns.transpose() * closure_taps(theta);
    const auto squares = [&](int at) { return Rgb(u[at] * u[at], u[at + 1] * u[at + 1], u[at + 2] * u[at + 2]); };
    network.diffuse[i] = squares(0);
    for (size_t k = 0; k < distributions.size(); ++k) {
      const int at = lobe_unknown(static_cast<int>(k));
      const ClosureShape s = closure_shape(u[at + 3], u[at + 4], u[at + 5], theta, bounds, distributions[k]);
      ClosureLobe& lobe = network.lobes[k];
      lobe.weight[i] = squares(at);
      lobe.roughness[i] = static_cast<float>(std::sqrt(s.alpha));
      lobe.tilt[i] = static_cast<float>(s.tilt);
      lobe.anisotropy[i] = static_cast<float>(s.anisotropy);
    }
  }
  return network;
}

}  // namespace velour
