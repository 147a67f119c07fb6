// The directional functions of a model of clustered tensors.
#pragma once

#include <array>
#include <span>
#include "btf/fit/seen_texels.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/model/tensor_btf.h"
#include "math/tensor/cluster_choice.h"

namespace velour {

/// Converts clusters found in bases of the views and lights to their stored form.
std::vector<TensorBtfCluster> stored_clusters(const ClusteredTensor& tensor, const DirectionBases& bases);

/// The part of a cluster that depends on directions and colors, as floats.
struct DirectionCluster {
  RowMatrix view, light, color;  // direction or axis x rank
  RowMatrix core;                // [texel rank, view rank] x [light rank, color rank]

  Index rank() const { return core.rows() / view.cols(); }
};

/// Conversion from and to the stored form.
std::vector<DirectionCluster> direction_clusters(const TensorSide& side);
void store(const DirectionCluster& cluster, TensorBtfCluster& to);

/// Functions of a view, [cluster, rank][light] per color axis.
using FunctionsOfView = std::array<RowMatrix, 3>;
FunctionsOfView functions_of_view(const std::vector<DirectionCluster>& clusters, Index view);

/// basis_{c,r}(v, l, a) of btf/model/tensor_btf.h for the stored clusters, and their products.
class TensorFunctions {
 public:
  /// The clusters of `side` must be set.
  TensorFunctions(const TensorSide& side, int threads, const Progress& progress);

  Index clusters() const { return static_cast<Index>(cluster_.size()); }
  Index rank() const { return rank_; }
  Index count() const { return clusters() * rank_; }
  Index views() const { return static_cast<Index>(products_.size()); }

  FunctionsOfView of_view(Index view) const { return functions_of_view(cluster_, view); }
  /// Products of any two functions over the lights and axes of a view: [cluster, rank][cluster, rank].
  const RowMatrix& products(Index view) const { return products_[static_cast<size_t>(view)]; }
  /// Sum over all views.
  const RowMatrix& products() const { return all_; }
  /// products() of a view with a weight for each light.
  RowMatrix weighed_products(Index view, const Eigen::VectorXf& weight) const;

  /// Rows and columns of the given clusters, with a ridge on the diagonal.
  static Eigen::MatrixXf of_members(const RowMatrix& products, Index rank, const std::vector<uint32_t>& members,
                                    float ridge);

 private:
  std::vector<DirectionCluster> cluster_;
  Index rank_;
  std::vector<RowMatrix> products_;
  RowMatrix all_;
};

// Texels of a level by their members.

/// The texels that have the same members, one set after the other: matrices of a set are needed once at a time.
class MemberSets {
 public:
  explicit MemberSets(const TensorTexelValues& values);

  size_t size() const { return first_.size() - 1; }
  std::span<const uint32_t> texels(size_t set) const {
    return std::span(texels_).subspan(first_[set], first_[set + 1] - first_[set]);
  }
  std::vector<uint32_t> members(size_t set) const {
    const std::span<const uint32_t> found = of(texels_[first_[set]]);
    return {found.begin(), found.end()};
  }

 private:
  std::span<const uint32_t> of(uint32_t texel) const {
    const auto count = static_cast<size_t>(values_.members());
    return std::span(values_.member).subspan(count * texel, count);
  }

  const TensorTexelValues& values_;
  std::vector<uint32_t> texels_;
  std::vector<size_t> first_;  // of each set in texels_, and the end
};

// Moments of images for fitting the functions of clustered tensors with given coefficients.

/// Sums over the texels of a view of the products of seen coefficients with each other and with the images: all that a
/// least-squares fit of functions (TensorFunctions) needs.
struct ViewMoments {
  ViewMoments(Index functions, Index lights);

  RowMatrix products;               // function x function
  std::array<RowMatrix, 3> images;  // per axis: function x light
};

/// Number of groups in which views are summed. Fixed, so that sums do not depend on threads.
inline constexpr size_t kMomentGroups = 4;

/// Adds a level with its images scaled by `brightness`. The same bits for any number of threads.
void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments);

/// Adds to the moments of all views the texels of a level that they hide and for which `view` stands in.
void add_hidden(const ShownViews& shown, Index view, const LevelImages& images, const TensorTexelValues& values,
                float brightness, int threads, const Progress& progress, std::vector<ViewMoments>& moments);

}  // namespace velour
