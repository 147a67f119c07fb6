// Search for the shape of clustered tensors with the smallest error within a number of bytes.
#pragma once

#include <optional>
#include <span>
#include <vector>
#include "base/progress.h"
#include "btf/model/tensor_btf.h"
#include "math/tensor/tensor_view.h"
#include "model/records.h"

namespace velour {

// The number and ranks of the clusters of a clustered-tensor model.

struct TensorShape {
  uint32_t clusters = 1, members = 1;
  TensorSide::Ranks rank{1, 1, 1, 1};

  /// Coefficients per texel.
  uint32_t coefficients() const { return members * rank.texel; }
  /// Directional functions of all clusters.
  uint32_t functions() const { return clusters * rank.texel; }
};

/// Sizes of a side that determine its shapes.
struct TensorExtent {
  uint64_t texels = 0;             // texels of all levels
  uint64_t finest = 0;             // texels of the finest level
  uint64_t views = 0, lights = 0;  // views and lights of the side
  bool relief = false;
  uint32_t view_rank = 0, light_rank = 0;  // upper bounds
  uint32_t functions = 640;                // upper bound
};

/// Stored size: TensorSide::parameter_bytes().
uint64_t tensor_bytes(const TensorShape& shape, const TensorExtent& extent);

/// A shape to try: clusters, members, color rank, and the texels' share of the bytes.
struct ShapeChoice {
  uint32_t clusters = 1, members = 1, colors = 3;
  double texel_share = 0.6;
};

/// The largest shape within the bytes: the texel rank from the texels' share, the ranks of views and lights from the
/// rest. No rank exceeds its extent. Empty if not even ranks of 1 fit.
std::optional<TensorShape> largest_shape(const ShapeChoice& choice, const TensorExtent& extent, uint64_t bytes);

/// Range of the search.
struct ShapeRange {
  uint32_t least_clusters = 1, most_clusters = 1;
  uint32_t least_members = 1, most_members = 1;
};

struct ShapeSearchOptions {
  ShapeRange range;
  TensorExtent extent;
  uint64_t bytes = 0;       // maximum size
  double relief_share = 0;  // ReliefGap::share()
  uint64_t seed = 0;
  int threads = 0;
};

struct JudgedShape {
  ShapeChoice choice;
  TensorShape shape;  // the largest one within the bytes
  double error = 0;   // expected relative L2 error of the images
};

struct FoundShape {
  JudgedShape best;
  std::optional<JudgedShape> rival;        // with other clusters and about as good: only fits of both can decide
  uint32_t view_rank = 0, light_rank = 0;  // maximum ranks, from the extent
  double relief_error = 0;                 // squared error that all shapes have in common
  std::vector<ShapeTrial> trials;          // in order
};

/// Whether a shape of `clusters` clusters with error `error` is preferred to one of `others` clusters with error
/// `least`. More clusters have to be better by one percent, because the texels by which shapes are judged flatter them.
/// (On the net, four clusters were expected to leave .2879 and one .2881; on the images they left .2883 and .2823.)
bool is_better_shape(uint32_t clusters, double error, uint32_t others, double least);

/// Whether `other`, with another number of clusters than `best`, may make the better model. Errors estimated from
/// slices are off by up to 8 %, and by less if texels have many coefficients. (Finished models of the net, with one
/// cluster and with four, deviated from the estimate by 6 % at 20 KB, 2 % at 50 KB and 0.5 % at 780 KB; on the weave at
/// 80 KB, two members were 4 % better than estimated and one cluster 1 % worse.)
bool is_rival(const JudgedShape& other, const JudgedShape& best);

/// Local search from one cluster, and from two and eight clusters with the texel share that the first walk found. A
/// walk moves to better neighbors (twice or half the clusters, a member more or fewer, another texel share, another
/// color rank) until there are none. A shape is judged by a short fit to some slices, [slice][view][light][color], and
/// its residual on others that the fit has not seen; if there are few slices, all are fitted and judged. The residual
/// of the relief in the images, which all shapes share, is added. If more clusters are hardly better, fewer are taken:
/// CTA and K-CTA then become Tucker decompositions. The rival is the walk's end with the fewest clusters that is close
/// to the best. Throws Error(invalid_argument) if no shape is within the bytes.
FoundShape search_shape(const TensorView& slices, const ShapeSearchOptions& options, Progress& progress);

}  // namespace velour
