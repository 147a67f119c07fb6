#include "compress/lobe_refinement.h"

#include "compress/projected_error.h"
#include "fit/lbfgs.h"

namespace velour {
namespace {

/// Vectors of lobes as the parameters of a descent, each measured by its length at the start, so that broad and narrow
/// lobes move alike.
class LobeVectors {
 public:
  explicit LobeVectors(std::vector<MultivariateLobe> lobes) : lobes_(std::move(lobes)) {
    for (MultivariateLobe& lobe : lobes_) {
      for (Vec3* v : {&lobe.light, &lobe.view, &lobe.half}) {
        // A vector of no length has no slope to leave by.
        if (glm::length(*v) == 0) *v = Vec3(0, 0, kBroadest);
        unit_.push_back(1 + static_cast<double>(glm::length(*v)));
      }
    }
  }

  Eigen::VectorXd start() {
    Eigen::VectorXd x(static_cast<Eigen::Index>(3 * unit_.size()));
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
  double unit(Eigen::Index i) const { return unit_[static_cast<size_t>(i) / 3]; }
  static float& component(std::vector<MultivariateLobe>& lobes, Eigen::Index i) {
    MultivariateLobe& lobe = lobes[static_cast<size_t>(i) / 9];
    Vec3* const vectors[] = {&lobe.light, &lobe.view, &lobe.half};
    return (*vectors[i / 3 % 3])[static_cast<int>(i % 3)];
  }

  std::vector<MultivariateLobe> lobes_;
  std::vector<double> unit_;
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
