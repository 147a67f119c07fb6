#include "math/tensor/cluster_fit.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::cluster_rests_test {
namespace {

constexpr Index kSlices = 9, kEntries = 1300, kRank = 2;

/// A tensor of three clusters, with two for each slice.
ClusteredTensor sparse() {
  ClusteredTensor tensor;
  tensor.extent = {kSlices, kEntries};
  tensor.cluster.resize(3);
  tensor.cluster[0].core = RowMatrix::Zero(kRank, 1);  // which rank() reads
  tensor.members = 2;
  for (uint32_t i = 0; i < kSlices; ++i) {
    const std::array<std::array<uint32_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
    tensor.member.insert(tensor.member.end(), pairs[i % 3].begin(), pairs[i % 3].end());
  }
  tensor.coefficient = test::random_matrix(kSlices, 2 * kRank, 5);
  return tensor;
}

TEST(ClusterRests, AreSlicesLessAllClustersButOne) {
  const DenseTensor slices = test::random_tensor({kSlices, kEntries}, 6);
  const ClusteredTensor tensor = sparse();
  std::vector<RowMatrix> basis;
  for (uint64_t c = 0; c < 3; ++c) basis.push_back(test::random_matrix(kRank, kEntries, 7 + c));
  const std::vector<Index> which{1, 4, 8, 0};
  for (uint32_t but = 0; but < 4; ++but) {  // the last is no cluster
    const DenseTensor rests = cluster_rests(slices.view(), tensor, basis, which, but, {.threads = 2}, Progress());
    ASSERT_EQ(rests.extent, (std::vector<Index>{4, kEntries}));
    for (size_t place = 0; place < which.size(); ++place) {
      const Index i = which[place];
      Eigen::RowVectorXf rest = Eigen::Map<const Eigen::RowVectorXf>(slices.data.data() + i * kEntries, kEntries);
      for (Index k = 0; k < 2; ++k) {
        const uint32_t c = tensor.member[static_cast<size_t>(2 * i + k)];
        if (c != but) rest -= tensor.coefficient.row(i).segment(k * kRank, kRank) * basis[c];
      }
      const Eigen::Map<const Eigen::RowVectorXf> found(rests.data.data() + static_cast<Index>(place) * kEntries,
                                                       kEntries);
      EXPECT_LT((found - rest).cwiseAbs().maxCoeff(), 1e-5f) << i << " without " << but;
    }
  }
}

TEST(ClusterRests, AreTheSlicesBeforeMembersAreChosen) {
  const DenseTensor slices = test::random_tensor({kSlices, kEntries}, 6);
  ClusteredTensor tensor = sparse();
  tensor.member.clear();
  const std::vector<Index> which{3};
  const DenseTensor rests = cluster_rests(slices.view(), tensor, {}, which, 0, {}, Progress());
  EXPECT_TRUE(std::equal(rests.data.begin(), rests.data.end(), slices.data.begin() + 3 * kEntries));
}

}  // namespace
}  // namespace velour::cluster_rests_test
