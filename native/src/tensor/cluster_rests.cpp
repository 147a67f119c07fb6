#include "tensor/cluster_rests.h"

#include <algorithm>

#include "job/parallel.h"
#include "tensor/matrix_product.h"

namespace velour {
namespace {

constexpr Index kRestColumns = 1024;  // per piece of work

/// The slices that have a given cluster as a member.
struct Group {
  std::vector<Index> place;  // rows in the result
  RowMatrix coefficient;     // [place][rank]
};

std::vector<Group> grouped(const ClusteredTensor& tensor, std::span<const Index> which, uint32_t but) {
  std::vector<Group> groups(tensor.cluster.size());
  if (tensor.member.empty()) return groups;
  const auto member = [&](size_t place, Index k) {
    return tensor.member[static_cast<size_t>(which[place] * tensor.members + k)];
  };
  const auto for_others = [&](const auto& use) {
    for (size_t place = 0; place < which.size(); ++place) {
      for (Index k = 0; k < tensor.members; ++k) {
        if (member(place, k) != but) use(place, k, groups[member(place, k)]);
      }
    }
  };
  for_others([](size_t place, Index, Group& group) { group.place.push_back(static_cast<Index>(place)); });
  for (Group& group : groups) group.coefficient.resize(static_cast<Index>(group.place.size()), tensor.rank());
  std::vector<Index> filled(groups.size(), 0);
  for_others([&](size_t place, Index k, Group& group) {
    Index& row = filled[static_cast<size_t>(&group - groups.data())];
    group.coefficient.row(row++) = tensor.coefficient.row(which[place]).segment(k * tensor.rank(), tensor.rank());
  });
  return groups;
}

/// Subtracts the part of one cluster from columns [begin, begin + count) of the residuals.
void subtract(const Group& group, const RowMatrix& basis, Index begin, Index count, RowMatrix& product,
              DenseTensor& rests) {
  const auto rows = static_cast<Index>(group.place.size());
  product.resize(rows, count);
  multiply({group.coefficient.data(), rows, basis.rows(), basis.rows(), 1},
           {basis.data() + begin, basis.rows(), count, basis.cols(), 1}, {product.data(), rows, count, count, 1});
  for (Index i = 0; i < rows; ++i) {
    float* const row = rests.data.data() + group.place[static_cast<size_t>(i)] * rests.extent[1] + begin;
    Eigen::Map<Eigen::RowVectorXf>(row, count) -= product.row(i);
  }
}

}  // namespace

DenseTensor cluster_rests(const TensorView& slices, const ClusteredTensor& tensor, const std::vector<RowMatrix>& basis,
                          std::span<const Index> which, uint32_t but, const TensorOptions& options,
                          const Progress& progress) {
  const Index entries = slices.size() / std::max<Index>(slices.extent(0), 1);
  const std::vector<Group> groups = grouped(tensor, which, but);
  DenseTensor rests({static_cast<Index>(which.size()), entries});
  parallel_pieces(
      static_cast<size_t>((entries + kRestColumns - 1) / kRestColumns), options.threads, progress, [&](size_t piece) {
        const Index begin = static_cast<Index>(piece) * kRestColumns, count = std::min(kRestColumns, entries - begin);
        for (size_t i = 0; i < which.size(); ++i) {
          std::copy_n(slices.data() + which[i] * entries + begin, count,
                      rests.data.begin() + static_cast<Index>(i) * entries + begin);
        }
        RowMatrix product;
        for (size_t c = 0; c < groups.size(); ++c) {
          if (!groups[c].place.empty()) subtract(groups[c], basis[c], begin, count, product, rests);
        }
      });
  return rests;
}

}  // namespace velour
