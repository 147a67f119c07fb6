#include "compress/view_svd_fit.h"

#include <algorithm>

#include "tensor/decompositions.h"
#include "tensor/mode_product.h"

namespace velour {
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
