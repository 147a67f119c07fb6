#include "brdf/fit/closures/closure_problem.h"

#include <cmath>

namespace velour {

ClosureProblem::ClosureProblem(const std::vector<ClosureViewSamples>& views,
                               std::vector<LobeDistribution> distributions, LobeMasking masking,
                               const ClosureBounds& bounds, const ClosureFreedoms& freedoms)
    : views_(views), distributions_(std::move(distributions)), masking_(masking), bounds_(bounds), freedoms_(freedoms) {
  for (const ClosureViewSamples& s : views_) taps_.push_back(closure_taps(s.theta_v));
}

namespace {

// Columns over the lights of a view, times root_weight: the diffuse lobe, then for each lobe its value and derivatives
// by its unknowns alpha, tilt and anisotropy (`kFull`), or its value alone.
constexpr int kFull = 4, kValueOnly = 1, kMaxColumns = 1 + kFull * kMaxClosureLobes;
using LobeColumns =
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, ClosureViewSamples::kMax, kMaxColumns>;
using ColumnVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxColumns, 1>;
using Residuals = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::ColMajor, ClosureViewSamples::kMax, 3>;

/// Factors that make derivatives by the unknowns of those by log(alpha_x), log(alpha_y) and the tilt.
struct ChainFactors {
  float alpha_x, alpha_y, tilt, anisotropy;
};

template <LobeDistribution distribution, LobeMasking masking, int columns>
void fill_lobe(const ClosureViewSamples& s, const LobeAtView& lobe, const ChainFactors& by, float* __restrict value,
               float* __restrict by_alpha, float* __restrict by_tilt, float* __restrict by_anisotropy) {
  for (int i = 0; i < s.count; ++i) {
    const LobeSample l =
        lobe_sample<distribution, masking>(lobe, s.wl_x[i], s.wl_y[i], s.wl_z[i], s.h_x[i], s.h_y[i], s.h_z[i]);
    const float v = l.value * s.root_weight[i];
    value[i] = v;
    if constexpr (columns == kFull) {
      by_alpha[i] = v * (l.by_x * by.alpha_x + l.by_y * by.alpha_y);
      by_tilt[i] = v * l.by_tilt * by.tilt;
      by_anisotropy[i] = v * (l.by_x - l.by_y) * by.anisotropy;
    }
  }
}

ChainFactors chain_factors(const ClosureShape& shape, double theta_v) {
  return {static_cast<float>(shape.log_alpha_by_alpha + shape.anisotropy_by_alpha),
          static_cast<float>(shape.log_alpha_by_alpha - shape.anisotropy_by_alpha),
          static_cast<float>(theta_v * shape.tilt_by_tilt), static_cast<float>(shape.anisotropy_by_anisotropy)};
}

/// The columns of a view, `columns` of each lobe.
template <int columns>
void fill_columns(const ClosureViewSamples& s, const std::vector<LobeDistribution>& distributions, LobeMasking masking,
                  const ClosureBounds& bounds, const ViewUnknowns& u, LobeColumns& out) {
  out.resize(s.count, 1 + columns * static_cast<int>(distributions.size()));
  for (int i = 0; i < s.count; ++i) out(i, 0) = s.wl_z[i] * s.root_weight[i] * (1 / kPi);
  for (int k = 0; k < static_cast<int>(distributions.size()); ++k) {
    const int at = lobe_unknown(k);
    const ClosureShape shape = closure_shape(u[at + 3], u[at + 4], u[at + 5], s.theta_v, bounds);
    const double stretch = std::exp(shape.anisotropy);
    const LobeDistribution distribution = distributions[static_cast<size_t>(k)];
    const LobeAtView lobe = lobe_at_view(distribution, masking, static_cast<float>(shape.alpha * stretch),
                                         static_cast<float>(shape.alpha / stretch),
                                         static_cast<float>(shape.tilt * s.theta_v), static_cast<float>(s.theta_v));
    const auto column = [&](int j) { return columns == kFull || j == 0 ? &out(0, 1 + columns * k + j) : nullptr; };
    with_lobe_kind(distribution, masking, [&]<LobeDistribution d, LobeMasking m>() {
      fill_lobe<d, m, columns>(s, lobe, chain_factors(shape, s.theta_v), column(0), column(1), column(2), column(3));
    });
  }
}

/// Differences of the model and the target, and of their albedos.
struct ViewResiduals {
  Residuals values;  // times root_weight
  double albedo[3];
};

template <int columns>
void find_residuals(const ClosureViewSamples& s, const LobeColumns& column, const ColumnVector& mass,
                    const ViewUnknowns& u, ViewResiduals& out) {
  out.values.resize(s.count, 3);
  const int lobes = static_cast<int>(column.cols() - 1) / columns;
  for (int c = 0; c < 3; ++c) {
    auto residual = out.values.col(c);
    residual =
        static_cast<float>(u[c] * u[c]) * column.col(0) - Eigen::Map<const Eigen::VectorXf>(s.target[c], s.count);
    out.albedo[c] = u[c] * u[c] * mass[0] - s.albedo[c];
    for (int k = 0; k < lobes; ++k) {
      const double root = u[lobe_unknown(k) + c];
      residual += static_cast<float>(root * root) * column.col(1 + columns * k);
      out.albedo[c] += root * root * mass[1 + columns * k];
    }
  }
}

constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};

double cost_of(const ClosureViewSamples& s, const ViewResiduals& r) {
  double sum = 0, luminance_sq = 0;
  for (int i = 0; i < s.count; ++i) {
    const double l = luminance(Rgb(r.values(i, 0), r.values(i, 1), r.values(i, 2)));
    luminance_sq += l * l;
  }
  for (int c = 0; c < 3; ++c) {
    sum += s.inverse_norm_sq[c] * static_cast<double>(r.values.col(c).squaredNorm());
    sum += s.inverse_albedo_sq[c] * r.albedo[c] * r.albedo[c];
  }
  return sum + s.inverse_norm_sq_luminance * luminance_sq;
}

/// Integrals of the columns over the hemisphere.
ColumnVector masses(const ClosureViewSamples& s, const LobeColumns& column) {
  return (column.transpose() * Eigen::Map<const Eigen::VectorXf>(s.root_weight, s.count)).cast<double>();
}

}  // namespace

double ClosureProblem::view_cost(size_t view, const ViewUnknowns& u) const {
  const ClosureViewSamples& s = views_[view];
  LobeColumns column;
  fill_columns<kValueOnly>(s, distributions_, masking_, bounds_, u, column);
  ViewResiduals r;
  find_residuals<kValueOnly>(s, column, masses(s, column), u, r);
  return cost_of(s, r);
}

namespace {

/// The derivative of f cos by an unknown: a column times a color.
struct UnknownColumn {
  int column;
  std::array<double, 3> color;
};

std::array<UnknownColumn, kMaxClosureUnknowns> unknown_columns(const ViewUnknowns& u, int lobes) {
  std::array<UnknownColumn, kMaxClosureUnknowns> out{};
  const auto set_roots = [&](int at, int column) {
    for (int c = 0; c < 3; ++c) {
      out[static_cast<size_t>(at + c)].column = column;
      out[static_cast<size_t>(at + c)].color[static_cast<size_t>(c)] = 2 * u[at + c];
    }
  };
  set_roots(0, 0);
  for (int k = 0; k < lobes; ++k) {
    const int at = lobe_unknown(k);
    set_roots(at, 1 + kFull * k);
    for (int j = 0; j < 3; ++j) {
      out[static_cast<size_t>(at + 3 + j)] = {2 + kFull * k + j,
                                              {u[at] * u[at], u[at + 1] * u[at + 1], u[at + 2] * u[at + 2]}};
    }
  }
  return out;
}

double luminance_of(const std::array<double, 3>& c) {
  return kLuminance[0] * c[0] + kLuminance[1] * c[1] + kLuminance[2] * c[2];
}

}  // namespace

// The derivative of any residual is a column times a number, so J^T J of a view follows from products of its few
// columns.
ClosureProblem::ViewNormal ClosureProblem::view_normal(size_t view, const ViewUnknowns& u) const {
  const ClosureViewSamples& s = views_[view];
  LobeColumns column;
  fill_columns<kFull>(s, distributions_, masking_, bounds_, u, column);
  const ColumnVector mass = masses(s, column);
  ViewResiduals r;
  find_residuals<kFull>(s, column, mass, u, r);
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxColumns, kMaxColumns> gram =
      column.transpose() * column;
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::ColMajor, kMaxColumns, 3> slope = column.transpose() * r.values;

  const int size = static_cast<int>(u.size());
  const auto derivative = unknown_columns(u, static_cast<int>(distributions_.size()));
  ViewNormal n;
  n.curvature.resize(size, size);
  n.slope.resize(size);
  for (int i = 0; i < size; ++i) {
    const auto& [a, color_a] = derivative[static_cast<size_t>(i)];
    const double luminance_a = luminance_of(color_a) * s.inverse_norm_sq_luminance;
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double of_channel = slope(a, static_cast<int>(c));
      sum += of_channel * (color_a[c] * s.inverse_norm_sq[c] + luminance_a * kLuminance[c]);
      sum += color_a[c] * mass[a] * r.albedo[c] * s.inverse_albedo_sq[c];
    }
    n.slope[i] = sum;
    for (int j = 0; j <= i; ++j) {
      const auto& [b, color_b] = derivative[static_cast<size_t>(j)];
      double of_values = luminance_a * luminance_of(color_b), of_albedo = 0;
      for (size_t c = 0; c < 3; ++c) {
        of_values += color_a[c] * color_b[c] * s.inverse_norm_sq[c];
        of_albedo += color_a[c] * color_b[c] * s.inverse_albedo_sq[c];
      }
      n.curvature(i, j) = n.curvature(j, i) =
          of_values * static_cast<double>(gram(a, b)) + of_albedo * mass[a] * mass[b];
    }
  }
  return n;
}

double ClosureProblem::cost(const ClosureUnknowns& u) const {
  double sum = 0;
  for (size_t v = 0; v < views_.size(); ++v) sum += view_cost(v, at_view(u, v));
  return sum;
}

ClosureProblem::Normal ClosureProblem::normal(const ClosureUnknowns& u) const {
  const int size = static_cast<int>(u.cols());
  Normal n(size * kClosureKnots);
  for (size_t v = 0; v < views_.size(); ++v) {
    const ViewNormal of_view = view_normal(v, at_view(u, v));
    const Eigen::Matrix<double, kClosureKnots, kClosureKnots> taps = taps_[v] * taps_[v].transpose();
    for (int i = 0; i < size; ++i) {
      n.slope.segment<kClosureKnots>(i * kClosureKnots) += of_view.slope[i] * taps_[v];
      for (int j = 0; j <= i; ++j) {
        n.curvature.block<kClosureKnots, kClosureKnots>(i * kClosureKnots, j * kClosureKnots) +=
            of_view.curvature(i, j) * taps;
      }
    }
  }
  n.curvature.triangularView<Eigen::StrictlyUpper>() = n.curvature.transpose();
  freeze(n);
  return n;
}

void ClosureProblem::freeze(Normal& n) const {
  for (int k = 0; k < static_cast<int>(distributions_.size()); ++k) {
    const int tilt = kClosureKnots * (lobe_unknown(k) + 4), anisotropy = tilt + kClosureKnots;
    for (int knot = 0; knot < kClosureKnots; ++knot) {
      if (!freedoms_.tilt) n.freeze(tilt + knot);
      if (!freedoms_.anisotropy || (freedoms_.pin_anisotropy && knot == 0)) n.freeze(anisotropy + knot);
    }
  }
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
