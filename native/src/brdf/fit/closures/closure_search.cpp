#include "brdf/fit/closures/closure_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "brdf/fit/closures/closure_problem.h"
#include "math/optimize/levenberg_marquardt.h"
#include "math/optimize/nnls.h"

namespace velour {

namespace {

/// A lobe to add.
struct ScannedLobe {
  LobeDistribution distribution;
  double alpha, tilt, anisotropy;  // tilt: relative to theta_v
  double cost = 0;
};

std::vector<ScannedLobe> scanned_lobes(const ClosureBounds& bounds) {
  constexpr int kAlphas = 7;
  std::vector<ScannedLobe> lobes;
  for (const LobeDistribution distribution : closure_distributions(bounds)) {
    for (int i = 0; i < kAlphas; ++i) {
      const double alpha = bounds.min_alpha * std::pow(0.8 / bounds.min_alpha, (i + 0.3) / (kAlphas - 0.7));
      lobes.push_back({distribution, alpha, 0, 0});
      if (bounds.frame == ClosureFrame::surface) {
        for (const double anisotropy : {-1.0, 1.0}) lobes.push_back({distribution, alpha, 0, anisotropy});
        continue;
      }
      if (alpha > 0.1) lobes.push_back({distribution, alpha, 0.3, 0});
      lobes.push_back({distribution, alpha, alpha > 0.1 ? 0.85 : 0.98, 0});  // retro-reflection
    }
  }
  return lobes;
}

/// `from` with the lobe and without weights for it.
ClosureSolution with_lobe(const ClosureSolution& from, const ScannedLobe& lobe, const ClosureBounds& bounds) {
  ClosureSolution s = from;
  s.distributions.push_back(lobe.distribution);
  const Eigen::Index at = from.unknowns.cols();
  s.unknowns.resize(kClosureKnots, at + 6);
  s.unknowns.leftCols(at) = from.unknowns;
  s.unknowns.rightCols(6).setZero();
  const auto knots = closure_knots();
  for (int k = 0; k < kClosureKnots; ++k) {
    s.unknowns(k, at + 3) = closure_alpha_unknown(lobe.alpha, bounds);
    s.unknowns(k, at + 5) = closure_anisotropy_unknown(lobe.anisotropy, s.unknowns(k, at + 3), bounds);
    if (lobe.tilt != 0) {
      s.unknowns(k, at + 4) = closure_tilt_unknown(lobe.tilt, knots[static_cast<size_t>(k)]);
    }
  }
  return s;
}

/// The best weights of all lobes at a view for given shapes, and their cost without luminance.
struct LobeWeights {
  Eigen::Matrix<double, 1 + kMaxClosureLobes, 3> weight = Eigen::Matrix<double, 1 + kMaxClosureLobes, 3>::Zero();
  double cost = 0;

  LobeWeights(const ClosureView& view, const ViewProducts& products) {
    const int lobes = products.rows;
    Eigen::MatrixXd gram(lobes, lobes);
    Eigen::VectorXd moment(lobes), mass(lobes);
    for (int i = 0; i < lobes; ++i) mass[i] = products.mass(i);
    for (int c = 0; c < 3; ++c) {
      const double of_values = view.inverse_norm_sq[c], of_albedo = view.inverse_albedo_sq[c];
      const double albedo = view.target.albedo[c];
      for (int i = 0; i < lobes; ++i) {
        moment[i] = of_values * static_cast<double>(products.target[i][c]) + of_albedo * albedo * mass[i];
        for (int j = 0; j < lobes; ++j) gram(i, j) = of_values * products.gram(i, j) + of_albedo * mass[i] * mass[j];
      }
      Eigen::VectorXd x = Eigen::VectorXd::Zero(lobes);
      solve_nnls(gram, moment, 1e-6, x);
      weight.col(c).head(lobes) = x;
      cost += of_values * view.target.norm_sq[c] + of_albedo * albedo * albedo - 2 * x.dot(moment) + x.dot(gram * x);
    }
  }
};

/// Finds starts for one set of views.
class ClosureScan {
 public:
  ClosureScan(const std::vector<ClosureView>& views, LobeMasking masking, const ClosureBounds& bounds)
      : views_(views), masking_(masking), bounds_(bounds) {}

  ViewProducts products_at(const ClosureSolution& s, const ClosureView& view) const {
    const ViewUnknowns u = s.unknowns.transpose() * view.taps;
    return ViewProducts(view.target, s.distributions, masking_, bounds_, u, false);
  }

  /// Cost over one view in three.
  double cost(const ClosureSolution& s) const {
    double sum = 0;
    for (size_t v = 1; v < views_.size(); v += 3) sum += LobeWeights(views_[v], products_at(s, views_[v])).cost;
    return sum;
  }

 private:
  const std::vector<ClosureView>& views_;
  LobeMasking masking_;
  ClosureBounds bounds_;
};

/// Albedo of the source at `theta_v`, by linear interpolation between the views.
Vec3d albedo_at(const std::vector<ClosureView>& views, double theta_v) {
  const auto theta_of = [&](size_t i) { return static_cast<double>(views[i].target.lights.theta_v()); };
  size_t i = 0;
  while (i + 2 < views.size() && theta_of(i + 1) < theta_v) ++i;
  const double step = std::max(theta_of(i + 1) - theta_of(i), 1e-9);  // views may differ in azimuth alone
  const double t = std::clamp((theta_v - theta_of(i)) / step, 0.0, 1.0);
  return glm::mix(views[i].target.albedo, views[i + 1].target.albedo, t);
}

constexpr double kNewShare = 0.3;

/// Gives the last lobe `share` of the source's albedo, and the others what is left.
void share_albedo(const std::vector<ClosureView>& views, double share, ClosureSolution& s) {
  const auto lobes = static_cast<int>(s.distributions.size());
  const bool first = lobes == 1;  // nothing but the diffuse lobe so far, and that without an albedo
  const auto knots = closure_knots();
  for (int l = 0; l < lobes; ++l) s.unknowns.middleCols<3>(l == 0 ? 0 : lobe_unknown(l - 1)) *= std::sqrt(1 - share);
  for (int k = 0; k < kClosureKnots; ++k) {
    const Vec3d albedo = albedo_at(views, knots[static_cast<size_t>(k)]);
    for (int c = 0; c < 3; ++c) {
      if (first) s.unknowns(k, c) = std::sqrt((1 - share) * albedo[c] + 1e-6);
      s.unknowns(k, lobe_unknown(lobes - 1) + c) = std::sqrt(share * albedo[c] + 1e-6);
    }
  }
}

}  // namespace

std::vector<ClosureSolution> closure_starts(const std::vector<ClosureView>& views, const ClosureSolution& from,
                                            LobeMasking masking, const ClosureBounds& bounds) {
  const ClosureScan scan(views, masking, bounds);
  std::vector<ScannedLobe> lobes = scanned_lobes(bounds);
  for (ScannedLobe& lobe : lobes) lobe.cost = scan.cost(with_lobe(from, lobe, bounds));
  std::stable_sort(lobes.begin(), lobes.end(),
                   [](const ScannedLobe& a, const ScannedLobe& b) { return a.cost < b.cost; });
  std::vector<ClosureSolution> starts;
  std::vector<ScannedLobe> kinds;
  for (const ScannedLobe& lobe : lobes) {
    const bool known = std::any_of(kinds.begin(), kinds.end(), [&](const ScannedLobe& k) {
      return k.distribution == lobe.distribution && (k.tilt > 0.5) == (lobe.tilt > 0.5);
    });
    if (known) continue;
    kinds.push_back(lobe);
    starts.push_back(with_lobe(from, lobe, bounds));
    share_albedo(views, kNewShare, starts.back());
  }
  return starts;
}

namespace {

constexpr DescentOptions kTrial{.steps = 8, .settled = 1e-3, .damping = 1e-2, .by_gain = true};
constexpr DescentOptions kFull{.steps = 25, .settled = 1e-3, .damping = 1e-2, .by_gain = true};

/// `s` with the other distribution for lobe `k`, and an alpha for about the same width.
ClosureSolution flipped(ClosureSolution s, size_t k, const ClosureBounds& bounds) {
  constexpr double kOtherAlpha = 1.4;  // of a lobe as wide as GGX
  LobeDistribution& distribution = s.distributions[k];
  const bool was_ggx = distribution == LobeDistribution::ggx;
  distribution = closure_distributions(bounds)[was_ggx ? 1 : 0];
  auto unknowns = s.unknowns.col(lobe_unknown(static_cast<int>(k)) + 3);
  for (int i = 0; i < kClosureKnots; ++i) {
    const double alpha = closure_shape(unknowns[i], 0, 0, 0, bounds).alpha;
    unknowns[i] = closure_alpha_unknown(std::min(was_ggx ? kOtherAlpha * alpha : alpha / kOtherAlpha, 1.0), bounds);
  }
  return s;
}

/// The results of descents from `starts`, at least one.
class ClosureSearch {
 public:
  ClosureSearch(const std::vector<ClosureView>& views, const ClosureSearchOptions& options, const Progress& progress)
      : views_(views), options_(options), progress_(progress) {}

  ClosureSolution descended(ClosureSolution s, const DescentOptions& descent) const {
    const ClosureProblem problem(views_, s.distributions, options_.masking, options_.bounds);
    s.unknowns = descend(
        problem, s.unknowns, [&] { progress_.check(); }, descent);
    s.cost = problem.cost(s.unknowns);
    return s;
  }

  ClosureSolution best_of(std::vector<ClosureSolution> starts, const DescentOptions& descent) const {
    parallel_pieces(starts.size(), options_.threads, progress_,
                    [&](size_t i) { starts[i] = descended(starts[i], descent); });
    return *std::min_element(starts.begin(), starts.end(),
                             [](const ClosureSolution& a, const ClosureSolution& b) { return a.cost < b.cost; });
  }

 private:
  const std::vector<ClosureView>& views_;
  const ClosureSearchOptions& options_;
  const Progress& progress_;
};

}  // namespace

ClosureSolution one_more_lobe(const std::vector<ClosureView>& views, const ClosureSolution& from,
                              const ClosureSearchOptions& options, const Progress& progress) {
  const ClosureSearch search(views, options, progress);
  // Short trials choose starts that end in poor minima.
  const ClosureSolution best = search.best_of(closure_starts(views, from, options.masking, options.bounds), kFull);
  std::vector<ClosureSolution> flips;
  for (size_t k = 0; k < best.distributions.size(); ++k) flips.push_back(flipped(best, k, options.bounds));
  const ClosureSolution flip = search.best_of(std::move(flips), kTrial);
  return flip.cost < best.cost ? search.descended(flip, kFull) : best;
}

}  // namespace velour
