#include "math/tensor/tensor_view.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::mode_product_test {
namespace {

const std::vector<Index> kExtents{5, 4, 3, 6};

/// An entry by its indices.
float at(const TensorView& view, const std::vector<Index>& index) {
  const float* place = view.data();
  for (size_t mode = 0; mode < index.size(); ++mode) place += index[mode] * view.stride(mode);
  return *place;
}

/// use(indices) of every entry.
template <class Use>
void for_entries(const std::vector<Index>& extents, const Use& use) {
  std::vector<Index> index(extents.size(), 0);
  for (;;) {
    use(index);
    size_t mode = extents.size();
    while (mode > 0 && ++index[mode - 1] == extents[mode - 1]) index[--mode] = 0;
    if (mode == 0) return;
  }
}

/// The product against its definition, entry by entry.
void expect_product(const TensorView& view, size_t mode) {
  const RowMatrix matrix = test::random_matrix(2, view.extent(mode), 9);
  const DenseTensor product = mode_product(view, mode, matrix, 2, Progress());
  ASSERT_EQ(product.extent[mode], 2);
  for_entries(product.extent, [&](const std::vector<Index>& index) {
    double sum = 0;
    std::vector<Index> from = index;
    for (Index i = 0; i < view.extent(mode); ++i) {
      from[mode] = i;
      sum += static_cast<double>(matrix(index[mode], i) * at(view, from));
    }
    ASSERT_NEAR(at(product.view(), index), sum, 1e-5) << "mode " << mode;
  });
}

TEST(ModeProduct, IsItsDefinition) {
  const DenseTensor tensor = test::random_tensor(kExtents, 1);
  for (size_t mode = 0; mode < kExtents.size(); ++mode) expect_product(tensor.view(), mode);
}

TEST(ModeProduct, OfAnyLayoutIsItsDefinition) {
  const DenseTensor tensor = test::random_tensor(kExtents, 2);
  for (const auto& order : {std::vector<size_t>{3, 2, 1, 0}, {1, 0, 3, 2}, {2, 3, 0, 1}}) {
    const TensorView turned = tensor.view().permuted(order);
    for (size_t mode = 0; mode < kExtents.size(); ++mode) {
      expect_product(turned, mode);
      expect_product(turned.range(1, 1, 2).range(3, 0, 3), mode);
    }
  }
}

TEST(ModeProduct, OfManyColumnsIsTheSameForAnyNumberOfThreads) {
  const DenseTensor tensor = test::random_tensor({3, 7, 2500}, 3);
  for (size_t mode = 0; mode < 2; ++mode) {
    const RowMatrix matrix = test::random_matrix(4, tensor.extent[mode], 4);
    const DenseTensor one = mode_product(tensor.view(), mode, matrix, 1, Progress()),
                      two = mode_product(tensor.view(), mode, matrix, 2, Progress());
    EXPECT_EQ(one.data, two.data);
    EXPECT_EQ(slice_products(tensor.view(), mode, 1, Progress()), slice_products(tensor.view(), mode, 2, Progress()));
  }
}

TEST(SliceProducts, AreTheirDefinition) {
  const DenseTensor tensor = test::random_tensor(kExtents, 5);
  for (size_t mode = 0; mode < kExtents.size(); ++mode) {
    const Eigen::MatrixXd products = slice_products(tensor.view(), mode, 2, Progress());
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(kExtents[mode], kExtents[mode]);
    for_entries(kExtents, [&](std::vector<Index> index) {
      const Index i = index[mode];
      const auto value = static_cast<double>(at(tensor.view(), index));
      for (index[mode] = 0; index[mode] < kExtents[mode]; ++index[mode]) {
        expected(i, index[mode]) += value * static_cast<double>(at(tensor.view(), index));
      }
    });
    EXPECT_LT((products - expected).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(TensorView, IsCopiedInItsOrder) {
  const DenseTensor tensor = test::random_tensor(kExtents, 6);
  const TensorView turned = tensor.view().permuted({2, 0, 3, 1});
  const DenseTensor copy = copied(turned);
  EXPECT_EQ(copy.extent, (std::vector<Index>{3, 5, 6, 4}));
  for_entries(copy.extent, [&](const std::vector<Index>& index) {
    ASSERT_EQ(at(copy.view(), index), at(turned, index));
    ASSERT_EQ(at(copy.view(), index), at(tensor.view(), {index[1], index[3], index[0], index[2]}));
  });
}

}  // namespace
}  // namespace velour::mode_product_test
