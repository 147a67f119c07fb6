#include "math/tensor/clustered_tensor.h"

#include "math/tensor/mode_product.h"

namespace velour {

RowMatrix TensorCluster::basis(const TensorOptions& options, const Progress& progress) const {
  std::vector<Index> extents{core.rows()};
  for (const RowMatrix& f : factor) extents.push_back(f.cols());
  DenseTensor tensor(extents);
  std::copy_n(core.data(), core.size(), tensor.data.begin());
  for (size_t mode = 0; mode < factor.size(); ++mode) {
    tensor = mode_product(tensor.view(), mode + 1, factor[mode], options.threads, progress);
  }
  return Eigen::Map<const RowMatrix>(tensor.data.data(), core.rows(),
                                     static_cast<Index>(tensor.data.size()) / core.rows());
}

Index ClusteredTensor::size() const {
  Index size = 1;
  for (size_t mode = 1; mode < extent.size(); ++mode) size *= extent[mode];
  return size;
}

Index ClusteredTensor::parameters() const {
  Index sum = coefficient.size();
  for (const TensorCluster& c : cluster) {
    sum += c.core.size();
    for (const RowMatrix& f : c.factor) sum += f.size();
  }
  return sum;
}

DenseTensor expanded(const ClusteredTensor& tensor, const TensorOptions& options, const Progress& progress) {
  DenseTensor slices(tensor.extent);
  std::vector<RowMatrix> basis;
  for (const TensorCluster& c : tensor.cluster) basis.push_back(c.basis(options, progress));
  for (Index i = 0; i < tensor.slices(); ++i) {
    Eigen::Map<Eigen::RowVectorXf> slice(slices.data.data() + i * tensor.size(), tensor.size());
    for (Index k = 0; k < tensor.members; ++k) {
      const auto part = tensor.coefficient.row(i).segment(k * tensor.rank(), tensor.rank());
      slice += part * basis[tensor.member[static_cast<size_t>(i * tensor.members + k)]];
    }
  }
  return slices;
}

}  // namespace velour
