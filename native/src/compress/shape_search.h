// Which shape of clustered tensors leaves least within a number of bytes.
#pragma once

#include <optional>
#include <span>

#include "compress/tensor_shape.h"
#include "job/progress.h"
#include "model/btf_record.h"
#include "tensor/tensor_view.h"

namespace velour {

/// What may be tried.
struct ShapeRange {
  uint32_t least_clusters = 1, most_clusters = 1;
  uint32_t least_members = 1, most_members = 1;
};

struct ShapeSearchOptions {
  ShapeRange range;
  TensorExtent extent;
  uint64_t bytes = 0;       // at most
  double relief_share = 0;  // ReliefGap::share()
  uint64_t seed = 0;
  int threads = 0;
};

struct JudgedShape {
  ShapeChoice choice;
  TensorShape shape;  // of the bytes
  double error = 0;   // relative L2 that is expected of the images
};

struct FoundShape {
  JudgedShape best;
  std::optional<JudgedShape> rival;        // of another number of clusters, about as good: only models of both can tell
  uint32_t view_rank = 0, light_rank = 0;  // at most: of the extent
  double relief_error = 0;                 // part of the errors, squared, that is the same for all shapes
  std::vector<ShapeTrial> trials;          // in their order
};

/// Whether a shape of `clusters` that leaves `error` is to be taken in place of one of `others` that leaves `least`.
/// More clusters have to be better by a hundredth: the texels that shapes are judged by flatter them. (On the net four
/// clusters were to leave .2879 and one .2881; of the images they left .2883 and .2823.)
bool is_better_shape(uint32_t clusters, double error, uint32_t others, double least);

/// Whether `other`, of another number of clusters than `best`, may make the better model. What slices tell is off by up
/// to 8 %, and by less where texels have many coefficients. (Finished models of the net, of one cluster and of four,
/// were 6 % apart from what was expected of them in 20 KB, 2 % in 50, and 0.5 % in 780; of the weave in 80 KB two
/// members were 4 % better than expected and one cluster 1 % worse.)
bool is_rival(const JudgedShape& other, const JudgedShape& best);

/// Walks from one cluster, and with the share of texels that ended with from two and from eight, to better neighbours -
/// twice or half the clusters, a member more or fewer, another share of texels, another rank of colours - until none
/// is. A shape is judged by short fits to some slices, [slice][view] [light][colour], and by what it leaves of others,
/// which the fit has not seen; few slices are all fitted and judged. To that comes what the relief leaves of the
/// images, which is the same for all shapes. Where more clusters are hardly better fewer are taken: CTA and K-CTA are
/// Tucker decompositions then. The rival is the end of fewest clusters that is close. Throws Error(invalid_argument)
/// when no shape is within the bytes.
FoundShape search_shape(const TensorView& slices, const ShapeSearchOptions& options, Progress& progress);

}  // namespace velour
