#include "btf/fit/svd/svd_fit.h"

#include <algorithm>
#include <string>
#include "base/parallel.h"
#include "math/sphere/random.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/mode_product.h"

namespace velour {

namespace {

constexpr int kPowerIterations = 2;
constexpr int kOversampling = 8;     // columns beyond the requested ones
constexpr uint64_t kFirstLook = 32;  // components to start with if a tolerance is given

/// Turns the response into orthonormal functions of the pair, the strongest first.
void rotate(RowMatrix& response, Eigen::VectorXd& energy) {
  const Eigen::MatrixXd exact = response.cast<double>();
  const Eigenpairs pairs = eigenpairs(exact.transpose() * exact);
  energy = pairs.value.cwiseMax(0.0);
  Eigen::MatrixXd functions = exact * pairs.vector;
  for (Eigen::Index c = 0; c < functions.cols(); ++c) {
    const double norm = std::sqrt(energy[c]);
    functions.col(c) *= norm > 0 ? 1 / norm : 0;
  }
  response = functions.cast<float>();
}

}  // namespace

SvdFitter::SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                     Progress& progress)
    : FactoredFitter(measurement, options, checkpoint, progress, false) {
  progress.stage("computing color axes", 0, 0.1);
  find_axes();
  const uint64_t most = most_components();
  uint64_t count = options.tolerance > 0 ? std::min(most, kFirstLook) : most;
  // Each sketch gets half of the remaining progress.
  for (double begin = 0.1;; begin = (begin + 1) / 2, count = std::min(most, 2 * count)) {
    sketch(count, begin, count == most ? 1.0 : (begin + 1) / 2);
    if (count == most || reaches(options.tolerance)) break;
  }
  bound(bytes(), "One component");
}

/// Finds at least `components` components.
void SvdFitter::sketch(uint64_t components, double begin, double end) {
  const auto columns = static_cast<Eigen::Index>(
      std::min({components + kOversampling, measurement_.layout().pairs(), measurement_.grid().texels()}));
  const auto name = [&](int passes) {
    return "sketch." + std::to_string(columns) + "." + std::to_string(passes) + ".";
  };
  int done = kPowerIterations;  // passes whose bases were restored
  while (done > 0 && !take_kept_bases(name(done), columns)) --done;
  for (size_t a = 0; a < 3; ++a) {
    if (done == 0) start(sketch_[a], columns, a);
    sketch_[a].response.resize(static_cast<Eigen::Index>(measurement_.layout().pairs()), columns);
  }
  for (int i = done; i <= kPowerIterations; ++i) {
    const double step = (end - begin) / (kPowerIterations + 1);
    progress_.stage("computing direction functions", begin + step * i, begin + step * (i + 1));
    pass(i < kPowerIterations);
    if (i == kPowerIterations) break;
    checkpoint_.forget("sketch.");
    for (size_t a = 0; a < 3; ++a) checkpoint_.keep(name(i + 1) + std::to_string(a), sketch_[a].basis);
    checkpoint_.write();
  }
  for (Sketch& s : sketch_) rotate(s.response, s.energy);
  rank(found(), FactoredBtf::kMaxComponents);
}

void SvdFitter::start(Sketch& sketch, Eigen::Index columns, size_t axis) const {
  const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
  sketch.basis.resize(texels, columns);
  for (Eigen::Index t = 0; t < texels; ++t) {
    RandomStream random(options_.seed, static_cast<uint64_t>(t), axis);
    // The sum of three uniform numbers is close enough to normal.
    for (Eigen::Index c = 0; c < columns; ++c) {
      const float u = random.next(), v = random.next();
      sketch.basis(t, c) = u + v + random.next() - 1.5f;
    }
  }
  sketch.basis = orthonormal(sketch.basis);
}

bool SvdFitter::take_kept_bases(const std::string& stage, Eigen::Index columns) {
  const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
  for (size_t a = 0; a < 3; ++a) {
    auto basis = checkpoint_.matrix(stage + std::to_string(a), texels, columns);
    if (!basis) return false;
    sketch_[a].basis = std::move(*basis);
  }
  return true;
}

/// Computes the response of every view to the basis; if `onward`, also its image, which becomes the next basis.
void SvdFitter::pass(bool continuation) {
  for (Sketch& s : sketch_) s.image.setZero(s.basis.rows(), continuation ? s.basis.cols() : 0);
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress_.check();
    views_.read(v, f_);
    views_.planes(f_, measurement_.grid().texels(), planes_);
    for (size_t a = 0; a < 3; ++a) respond(sketch_[a], planes_[a], v, continuation);
    progress_.update(static_cast<double>(v + 1) / views_.views());
  }
  if (!continuation) return;
  for (Sketch& s : sketch_) {
    s.basis = s.image;
    s.basis = orthonormal(s.basis);
  }
}

void SvdFitter::respond(Sketch& s, const RowMatrix& plane, uint32_t view, bool continuation) const {
  const auto first = static_cast<Eigen::Index>(measurement_.layout().first(view));
  for_blocks(plane.rows(), kBlockRows, options_.threads, progress_, [&](Eigen::Index row, Eigen::Index count) {
    s.response.middleRows(first + row, count).noalias() = plane.middleRows(row, count) * s.basis;
  });
  if (!continuation) return;
  const auto response = s.response.middleRows(first, plane.rows());
  for_blocks(plane.cols(), kBlockColumns, options_.threads, progress_, [&](Eigen::Index column, Eigen::Index count) {
    s.image.middleRows(column, count).noalias() += plane.middleCols(column, count).transpose() * response;
  });
}

std::vector<SvdFitter::Component> SvdFitter::found() const {
  std::vector<Component> components;
  for (uint8_t a = 0; a < 3; ++a) {
    for (Eigen::Index c = 0; c < sketch_[a].energy.size(); ++c) components.push_back({0, a, c, sketch_[a].energy[c]});
  }
  return components;
}

bool SvdFitter::reaches(double error) const { return curve_.points.back().relative_l2 <= error; }

void SvdFitter::copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const {
  values = sketch_[component.axis].response.col(component.column);
}

namespace {

constexpr double kViewColors = 0.3;  // fraction of the progress at which they end

/// Number of components kept per view and axis.
uint64_t columns_of(const BtfMeasurement& measurement) {
  return std::min<uint64_t>(
      {measurement.layout().lights().size(), measurement.grid().texels(), FactoredBtf::kMaxOfView / 3});
}

}  // namespace

ViewSvdFitter::ViewSvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                             Progress& progress)
    : FactoredFitter(measurement, options, checkpoint, progress, true) {
  const uint64_t most = most_components();
  progress.stage("computing color axes", 0, kViewColors);
  find_axes();
  progress.stage("computing direction functions", kViewColors, 1);
  std::vector<Component> components;
  function_of_.resize(views_.views());
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress.check();
    decompose(v, components);
    progress.update(static_cast<double>(v + 1) / views_.views());
  }
  rank(std::move(components), most);
  bound(bytes(), "One component");
}

void ViewSvdFitter::decompose(uint32_t view, std::vector<Component>& components) {
  views_.read(view, f_);
  views_.planes(f_, measurement_.grid().texels(), planes_);
  const auto columns = static_cast<Eigen::Index>(columns_of(measurement_));
  for (uint8_t a = 0; a < 3; ++a) {
    const TensorView plane(planes_[a].data(), {planes_[a].rows(), planes_[a].cols()});
    const Eigenpairs pairs = eigenpairs(slice_products(plane, 0, options_.threads, progress_));
    function_of_[view][a] = pairs.vector.leftCols(columns).cast<float>();
    const Eigen::VectorXd energy = pairs.value.cwiseMax(0.0);
    for (Eigen::Index c = 0; c < columns; ++c) components.push_back({view, a, c, energy[c]});
  }
}

void ViewSvdFitter::copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const {
  values = function_of_[component.view][component.axis].col(component.column);
}

}  // namespace velour
