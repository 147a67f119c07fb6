#include "brdf/fit/closures/closure_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <Eigen/Cholesky>

#include "math/sphere/vec.h"

namespace velour {

namespace {

ClosureLobeShape shape_of(const ClosureShape& s, LobeDistribution distribution, LobeMasking masking, double theta_v) {
  const double stretch = std::exp(s.anisotropy);
  return {.distribution = distribution,
          .masking = masking,
          .alpha_x = static_cast<float>(s.alpha * stretch),
          .alpha_y = static_cast<float>(s.alpha / stretch),
          .tilt = static_cast<float>(s.tilt * theta_v)};
}

LobeChain chain_of(const ClosureShape& s, double theta_v) {
  const auto stretch = static_cast<float>(s.anisotropy_by_anisotropy);
  return {.alpha_x = static_cast<float>(s.log_alpha_by_alpha + s.anisotropy_by_alpha),
          .alpha_y = static_cast<float>(s.log_alpha_by_alpha - s.anisotropy_by_alpha),
          .tilt = static_cast<float>(theta_v * s.tilt_by_tilt),
          .stretch_x = stretch,
          .stretch_y = -stretch};
}

}  // namespace

ViewProducts::ViewProducts(const ClosureTarget& target_at_view, const std::vector<LobeDistribution>& distributions,
                           LobeMasking masking, const ClosureBounds& bounds, const ViewUnknowns& u, bool slopes)
    : rows_per_lobe(slopes ? kSlopeRows : 1) {
  const ClosureLights& lights = target_at_view.lights;
  const size_t padded = lights.padded();
  const auto theta_v = static_cast<double>(lights.theta_v());
  rows = 1 + rows_per_lobe * static_cast<int>(distributions.size());
  AlignedArray<float> data(static_cast<size_t>(rows) * padded);
  for (size_t i = 0; i < padded; ++i) data.data()[i] = lights.wl_z()[i] * lights.root_weight()[i] * (1 / kPi);
  for (size_t k = 0; k < distributions.size(); ++k) {
    const int at = lobe_unknown(static_cast<int>(k));
    const ClosureShape s = closure_shape(u[at + 3], u[at + 4], u[at + 5], theta_v, bounds, distributions[k]);
    const ClosureLobeShape shape = shape_of(s, distributions[k], masking, theta_v);
    float* out = data.data() + (1 + k * static_cast<size_t>(rows_per_lobe)) * padded;
    slopes ? fill_lobe_slopes(lights, shape, chain_of(s, theta_v), out) : fill_lobe(lights, shape, out);
  }
  const float* const fixed[4] = {target_at_view.channel(0), target_at_view.channel(1), target_at_view.channel(2),
                                 target_at_view.integral.data()};
  fill_products(data.data(), rows, padded, fixed, gram_, target);
}

std::vector<ClosureView> closure_views(std::vector<ClosureTarget> targets) {
  constexpr double kMinView = 1e-3, kMinChannel = 0.02;
  const auto largest_of = [](const Vec3d& c) { return std::max({c.r, c.g, c.b}); };
  double largest = 0, largest_albedo = 0;
  for (const ClosureTarget& t : targets) {
    largest = std::max(largest, t.norm_sq_luminance);
    largest_albedo = std::max(largest_albedo, largest_of(t.albedo));
  }
  std::vector<ClosureView> views;
  if (!(largest > 0)) return views;
  for (ClosureTarget& t : targets) {
    ClosureView view{.target = std::move(t), .taps = {}};
    const ClosureTarget& of = view.target;
    const double least = std::max(of.norm_sq_luminance, kMinView * kMinView * largest);
    const double least_albedo = kMinChannel * std::max(largest_of(of.albedo), kMinView * largest_albedo);
    view.inverse_norm_sq_luminance = 1 / least;
    for (int c = 0; c < 3; ++c) {
      view.inverse_norm_sq[c] = 1 / std::max(of.norm_sq[c], kMinChannel * kMinChannel * least);
      view.inverse_albedo_sq[c] = std::pow(std::max(of.albedo[c], least_albedo), -2);
    }
    view.taps = closure_taps(static_cast<double>(of.lights.theta_v()));
    views.push_back(std::move(view));
  }
  return views;
}

ClosureProblem::ClosureProblem(const std::vector<ClosureView>& views, std::vector<LobeDistribution> distributions,
                               LobeMasking masking, const ClosureBounds& bounds)
    : views_(views), distributions_(std::move(distributions)), masking_(masking), bounds_(bounds) {}

namespace {

/// Colors of the lobes at a view: the diffuse one, then the others.
struct LobeColors {
  int count;
  std::array<std::array<double, 3>, 1 + kMaxClosureLobes> color;
};

LobeColors colors_of(const ViewUnknowns& u) {
  LobeColors colors{1 + static_cast<int>(u.size() - 3) / 6, {}};
  for (int l = 0; l < colors.count; ++l) {
    const int at = l == 0 ? 0 : lobe_unknown(l - 1);
    for (int c = 0; c < 3; ++c) {
      colors.color[static_cast<size_t>(l)][static_cast<size_t>(c)] = u[at + c] * u[at + c];
    }
  }
  return colors;
}

/// Products of each row with the residual of each channel, and the residuals of albedos.
struct ViewResiduals {
  double albedo[3];
  double by_row[ViewProducts::kMaxRows][3];
  double cost;
};

/// All residuals follow from products of rows with each other and with the target. Row `stride` l is the value of lobe
/// l - 1, row 0 the diffuse one.
ViewResiduals residuals_of(const ClosureView& view, const ViewProducts& products, const LobeColors& colors) {
  ViewResiduals r{};
  const auto value_row = [&](int l) { return l == 0 ? 0 : 1 + (l - 1) * products.rows_per_lobe; };
  for (int row = 0; row < products.rows; ++row) {
    for (int c = 0; c < 3; ++c) {
      double sum = -static_cast<double>(products.target[row][c]);
      for (int l = 0; l < colors.count; ++l) {
        sum += colors.color[static_cast<size_t>(l)][static_cast<size_t>(c)] * products.gram(row, value_row(l));
      }
      r.by_row[row][c] = sum;
    }
  }
  const ClosureTarget& target = view.target;
  double luminance_sq = target.norm_sq_luminance;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<size_t>(c);
    double sum_sq = target.norm_sq[c];
    r.albedo[c] = -target.albedo[c];
    for (int l = 0; l < colors.count; ++l) {
      const double color = colors.color[static_cast<size_t>(l)][channel];
      const int row = value_row(l);
      sum_sq += color * (r.by_row[row][c] - products.target[row][c]);
      r.albedo[c] += color * products.mass(row);
    }
    r.cost += view.inverse_norm_sq[c] * std::max(sum_sq, 0.0) + view.inverse_albedo_sq[c] * r.albedo[c] * r.albedo[c];
  }
  for (int l = 0; l < colors.count; ++l) {
    const auto& color = colors.color[static_cast<size_t>(l)];
    const int row = value_row(l);
    const double bright = kLuminance[0] * color[0] + kLuminance[1] * color[1] + kLuminance[2] * color[2];
    double product = 0;
    for (int c = 0; c < 3; ++c) product += kLuminance[c] * (r.by_row[row][c] - products.target[row][c]);
    luminance_sq += bright * product;
  }
  r.cost += view.inverse_norm_sq_luminance * std::max(luminance_sq, 0.0);
  return r;
}

/// The derivative of f cos by an unknown: a row times a color.
struct UnknownRow {
  int row;
  std::array<double, 3> color;
};

std::array<UnknownRow, kMaxClosureUnknowns> unknown_rows(const ViewUnknowns& u, const LobeColors& colors) {
  std::array<UnknownRow, kMaxClosureUnknowns> out{};
  for (int l = 0; l < colors.count; ++l) {
    const int at = l == 0 ? 0 : lobe_unknown(l - 1), row = l == 0 ? 0 : 1 + (l - 1) * ViewProducts::kSlopeRows;
    for (int c = 0; c < 3; ++c) {
      out[static_cast<size_t>(at + c)].row = row;
      out[static_cast<size_t>(at + c)].color[static_cast<size_t>(c)] = 2 * u[at + c];
    }
    for (int j = 1; l > 0 && j < ViewProducts::kSlopeRows; ++j) {
      out[static_cast<size_t>(at + 2 + j)] = {row + j, colors.color[static_cast<size_t>(l)]};
    }
  }
  return out;
}

double brightness_of(const std::array<double, 3>& c) {
  return kLuminance[0] * c[0] + kLuminance[1] * c[1] + kLuminance[2] * c[2];
}

}  // namespace

/// Curvature (lower triangle) and slope by the unknowns of one view.
struct ClosureProblem::ViewNormal {
  double curvature[kMaxClosureUnknowns][kMaxClosureUnknowns], slope[kMaxClosureUnknowns];

  ViewNormal(const ClosureView& view, const ViewProducts& products, const ViewUnknowns& u) {
    const LobeColors colors = colors_of(u);
    const ViewResiduals r = residuals_of(view, products, colors);
    const auto derivative = unknown_rows(u, colors);
    for (int i = 0; i < u.size(); ++i) {
      const auto& [a, color_a] = derivative[static_cast<size_t>(i)];
      const double luminance_a = brightness_of(color_a) * view.inverse_norm_sq_luminance;
      std::array<double, 3> of_values, of_albedo;
      double sum = 0;
      for (size_t c = 0; c < 3; ++c) {
        of_values[c] = color_a[c] * view.inverse_norm_sq[c] + luminance_a * kLuminance[c];
        of_albedo[c] = color_a[c] * products.mass(a) * view.inverse_albedo_sq[c];
        sum += r.by_row[a][c] * of_values[c] + of_albedo[c] * r.albedo[c];
      }
      slope[i] = sum;
      for (int j = 0; j <= i; ++j) {
        const auto& [b, color_b] = derivative[static_cast<size_t>(j)];
        double by_values = 0, by_albedo = 0;
        for (size_t c = 0; c < 3; ++c) {
          by_values += of_values[c] * color_b[c];
          by_albedo += of_albedo[c] * color_b[c];
        }
        curvature[i][j] = by_values * products.gram(a, b) + by_albedo * products.mass(b);
      }
    }
  }
};

namespace {

/// The penalty on bent curves of shapes is kBending times the squares of second differences between knots. It keeps
/// curves smooth where a lobe has little weight, and costs the others next to nothing.
constexpr double kBending = 1e-3;

using KnotSquare = Eigen::Matrix<double, kClosureKnots, kClosureKnots>;

KnotSquare bending() {
  Eigen::Matrix<double, kClosureKnots - 2, kClosureKnots> second = decltype(second)::Zero();
  for (int k = 0; k + 2 < kClosureKnots; ++k) second.block<1, 3>(k, k) << 1, -2, 1;
  return kBending * second.transpose() * second;
}

/// Calls `use` with the index of each unknown of a view that is a shape.
template <class Use>
void for_each_shape(int lobes, const Use& use) {
  for (int k = 0; k < lobes; ++k) {
    for (int j = 3; j < 6; ++j) use(lobe_unknown(k) + j);
  }
}

}  // namespace

double ClosureProblem::cost(const ClosureUnknowns& u) const {
  double sum = 0;
  const KnotSquare bend = bending();
  for_each_shape(static_cast<int>(distributions_.size()), [&](int i) { sum += u.col(i).dot(bend * u.col(i)); });
  for (const ClosureView& view : views_) {
    const ViewUnknowns at_view = u.transpose() * view.taps;
    const ViewProducts products(view.target, distributions_, masking_, bounds_, at_view, false);
    sum += residuals_of(view, products, colors_of(at_view)).cost;
  }
  return sum;
}

void ClosureProblem::add_to(Normal& n, const ClosureView& view, const ViewNormal& of_view) const {
  const Eigen::Matrix<double, kClosureKnots, kClosureKnots> taps = view.taps * view.taps.transpose();
  const int size = static_cast<int>(n.slope.size()) / kClosureKnots;
  for (int i = 0; i < size; ++i) {
    n.slope.segment<kClosureKnots>(i * kClosureKnots) += of_view.slope[i] * view.taps;
    for (int j = 0; j <= i; ++j) {
      n.curvature.block<kClosureKnots, kClosureKnots>(i * kClosureKnots, j * kClosureKnots) +=
          of_view.curvature[i][j] * taps;
    }
  }
}

ClosureProblem::Normal ClosureProblem::normal(const ClosureUnknowns& u) const {
  const Eigen::Index size = u.cols() * kClosureKnots;
  Normal n{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (const ClosureView& view : views_) {
    const ViewUnknowns at_view = u.transpose() * view.taps;
    const ViewProducts products(view.target, distributions_, masking_, bounds_, at_view, true);
    add_to(n, view, ViewNormal(view, products, at_view));
  }
  const KnotSquare bend = bending();
  for_each_shape(static_cast<int>(distributions_.size()), [&](int i) {
    n.curvature.block<kClosureKnots, kClosureKnots>(i * kClosureKnots, i * kClosureKnots) += bend;
    n.slope.segment<kClosureKnots>(i * kClosureKnots) += bend * u.col(i);
  });
  return n;
}

// Unknowns that hardly matter, such as the shape of a lobe of little weight, would take long steps otherwise.
constexpr double kMinDamped = 0.05;

Eigen::VectorXd ClosureProblem::Normal::step(double damping) const {
  Eigen::MatrixXd damped = curvature;
  damped.diagonal() += damping * curvature.diagonal().cwiseMax(kMinDamped);
  damped.diagonal().array() += 1e-12;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(damped);
  if (factors.info() != Eigen::Success) return Eigen::VectorXd::Zero(slope.size());  // no gain: more damping follows
  return -factors.solve(slope);
}

ClosureUnknowns ClosureProblem::moved(const ClosureUnknowns& u, const Eigen::VectorXd& step) const {
  constexpr double kLongest = 2, kFarthest = 8;  // of unknowns that exponentials map; the linear model holds no further
  ClosureUnknowns to = u + Eigen::Map<const ClosureUnknowns>(step.data(), kClosureKnots, u.cols());
  for (int k = 0; k < static_cast<int>(distributions_.size()); ++k) {
    auto shape = to.middleCols(lobe_unknown(k) + 3, 3);
    const auto before = u.middleCols(lobe_unknown(k) + 3, 3);
    shape = shape.cwiseMax((before.array() - kLongest).matrix()).cwiseMin((before.array() + kLongest).matrix());
    shape = shape.cwiseMax(-kFarthest).cwiseMin(kFarthest);
  }
  return to;
}

}  // namespace velour
