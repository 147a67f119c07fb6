#include "compress/lobe_refinement.h"

#include <algorithm>

#include "compress/projected_error.h"
#include "fit/lbfgs.h"

namespace velour {
namespace {

/// The numbers of lobes as parameters of a descent, each argument in units of its initial length, so that broad and
/// narrow lobes move alike.
class LobeVectors {
 public:
  explicit LobeVectors(std::vector<MultivariateLobe> lobes) : lobes_(std::move(lobes)) {
    for (MultivariateLobe& lobe : lobes_) {
      for (int a = 0; a < MultivariateLobe::kArguments; ++a) {
        // A zero vector has no slope.
        const int last = std::min(3 * a + 2, MultivariateLobe::kNumbers - 1);
        if (lobe.length(a) == 0) lobe[last] = kBroadest;
        for (int i = 3 * a; i <= last; ++i) unit_.push_back(1 + static_cast<double>(lobe.length(a)));
      }
    }
  }

  Eigen::VectorXd start() {
    Eigen::VectorXd x(static_cast<Eigen::Index>(unit_.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = static_cast<double>(component(lobes_, i)) / unit(i);
    return x;
  }
  std::vector<MultivariateLobe> at(const Eigen::VectorXd& x) const {
    std::vector<MultivariateLobe> lobes = lobes_;
    for (Eigen::Index i = 0; i < x.size(); ++i) component(lobes, i) = static_cast<float>(x[i] * unit(i));
    return lobes;
  }
  Eigen::VectorXd slope(const Eigen::MatrixXd& by_vector) const {
    Eigen::VectorXd slope = Eigen::Map<const Eigen::VectorXd>(by_vector.data(), by_vector.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) slope[i] *= unit(i);
    return slope;
  }

 private:
  static constexpr float kBroadest = 0.05f;
  double unit(Eigen::Index i) const { return unit_[static_cast<size_t>(i)]; }
  static float& component(std::vector<MultivariateLobe>& lobes, Eigen::Index i) {
    const auto number = static_cast<int>(i);
    return lobes[static_cast<size_t>(number / MultivariateLobe::kNumbers)][number % MultivariateLobe::kNumbers];
  }

  std::vector<MultivariateLobe> lobes_;
  std::vector<double> unit_;  // per number
};

}  // namespace

std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress) {
  const ProjectedError error(points, options.tile_lobes, options.threads, progress);
  LobeVectors vectors(std::move(lobes));
  Eigen::MatrixXd by_vector;
  const auto f = [&](const Eigen::VectorXd& x, Eigen::VectorXd& slope) {
    const double value = error(vectors.at(x), by_vector);
    slope = vectors.slope(by_vector);
    return value;
  };
  LbfgsOptions descent;
  descent.steps = options.steps;
  const auto after_step = [&](int step) { progress.update(static_cast<double>(step + 1) / options.steps); };
  return vectors.at(descend_lbfgs(f, vectors.start(), descent, after_step));
}

}  // namespace velour
