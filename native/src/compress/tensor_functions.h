// The functions of the directions that a model of clustered tensors is made of.
#pragma once

#include <array>

#include "btf/tensor_btf.h"
#include "compress/direction_bases.h"
#include "tensor/clustered_tensor.h"

namespace velour {

/// What was found in bases of the views and lights, as it is stored.
std::vector<TensorBtfCluster> stored_clusters(const ClusteredTensor& tensor, const DirectionBases& bases);

/// The part of a cluster that depends on directions and colours, as floats.
struct DirectionCluster {
  RowMatrix view, light, color;  // direction or axis x rank
  RowMatrix core;                // [rank of the texels, of the views] x [of the lights, of the colours]

  Index rank() const { return core.rows() / view.cols(); }
};

/// As they are stored.
std::vector<DirectionCluster> direction_clusters(const TensorSide& side);
void store(const DirectionCluster& cluster, TensorBtfCluster& to);

/// Functions [cluster, rank][light] of each colour axis, for a view.
using FunctionsOfView = std::array<RowMatrix, 3>;
FunctionsOfView functions_of_view(const std::vector<DirectionCluster>& clusters, Index view);

/// basis_{c,r}(v, l, a) of btf/tensor_btf.h by what is stored, and their products.
class TensorFunctions {
 public:
  /// Of `side`, whose clusters are set.
  TensorFunctions(const TensorSide& side, int threads, const Progress& progress);

  Index clusters() const { return static_cast<Index>(cluster_.size()); }
  Index rank() const { return rank_; }
  Index count() const { return clusters() * rank_; }
  Index views() const { return static_cast<Index>(products_.size()); }

  FunctionsOfView of_view(Index view) const { return functions_of_view(cluster_, view); }
  /// Any two functions over the lights and axes of a view: [cluster, rank][cluster, rank].
  const RowMatrix& products(Index view) const { return products_[static_cast<size_t>(view)]; }
  /// Over all views.
  const RowMatrix& products() const { return all_; }
  /// The same with each light weighed.
  RowMatrix weighed_products(Index view, const Eigen::VectorXf& weight) const;

  /// Rows and columns of some clusters, with a ridge on the diagonal.
  static Eigen::MatrixXf of_members(const RowMatrix& products, Index rank, const std::vector<uint32_t>& members,
                                    float ridge);

 private:
  std::vector<DirectionCluster> cluster_;
  Index rank_;
  std::vector<RowMatrix> products_;
  RowMatrix all_;
};

}  // namespace velour
