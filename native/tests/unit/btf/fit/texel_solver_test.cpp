#include "btf/fit/srbf/texel_solver.h"

#include <gtest/gtest.h>

#include "base/memory.h"
#include "btf/model/srbf_btf.h"
#include "image/texels.h"
#include "math/sphere/random.h"
#include "support/example_srbf.h"
#include "support/simd_targets.h"

namespace velour::texel_solver_test {
namespace {

void nothing(int) {}

SideDirections directions() { return sides_of({even_directions(20), even_directions(16)}).at(0); }

SharedLobes lobes() {
  const SrbfSide side = test::example_side(2, 2, false);
  return {side.lobes, side.tile_lobes, side.lobe};
}

Relief relief_of(uint32_t width, uint32_t height, float high) {
  std::vector<float> heights;
  for (uint32_t t = 0; t < width * height; ++t) heights.push_back(high * std::sin(0.9f * static_cast<float>(t)));
  return {width, height, heights, static_cast<float>(height) / static_cast<float>(width)};
}

RowMatrix random_coefficients(const Relief& relief, Eigen::Index count) {
  RandomStream random(13, 0, 0);
  return RowMatrix::NullaryExpr(Eigen::Index{relief.width()} * relief.height(), count,
                                [&] { return random.next() - 0.3f; });
}

/// What the coefficients mean, in double: the images of a view.
LevelImages images_of(const SideDirections& side, const SharedLobes& shared, const Relief& relief,
                      const RowMatrix& coefficient, size_t view) {
  LevelImages images{relief.width(), relief.height(), {}};
  const Eigen::Index texels = coefficient.rows(), lights = static_cast<Eigen::Index>(side.light.size());
  for (RowMatrix& axis : images.value) axis.setZero(texels, lights);
  for (Eigen::Index t = 0; t < texels; ++t) {
    const auto x = static_cast<float>(t % relief.width()), y = static_cast<float>(t / relief.width());
    const Vec2 place((x + 0.5f) / static_cast<float>(relief.width()), (y + 0.5f) / static_cast<float>(relief.height()));
    const BilinearTexels at = bilinear_texels(relief.seen(place, side.view[view]), relief.width(), relief.height());
    Vec2 slope(0.0f);
    Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(coefficient.cols());
    for (size_t i = 0; i < 4; ++i) {
      slope += at.weight[i] * relief.slope(at.index[i] % relief.width(), at.index[i] / relief.width());
      value += static_cast<double>(at.weight[i]) * coefficient.row(at.index[i]).cast<double>();
    }
    const Mat3 turn = to_normal(slope);
    for (Eigen::Index l = 0; l < lights; ++l) {
      const LobeArguments tile({side.light[static_cast<size_t>(l)], side.view[view]}), turned = tile.turned(turn);
      Eigen::Index k = 0;
      for (size_t a = 0; a < 3; ++a) {
        double sum = 0;
        for (const uint16_t j : shared.lobe[a]) {
          sum += value[k++] * test::lobe_value(shared.lobes[j], j < shared.tile_lobes ? tile : turned);
        }
        images.value[a](t, l) = static_cast<float>(sum);
      }
    }
  }
  return images;
}

RowMatrix solved(const SideDirections& side, const SharedLobes& shared, const Relief& relief,
                 const RowMatrix& coefficient, int steps, int threads = 2) {
  const Progress progress;
  TexelSolver solver(side, shared, relief, threads, progress);
  for (size_t v = 0; v < side.view.size(); ++v) {
    solver.add_view(v, images_of(side, shared, relief, coefficient, v));
  }
  return solver.solve(RowMatrix::Zero(coefficient.rows(), coefficient.cols()), steps, nothing);
}

float relative_error(const RowMatrix& found, const RowMatrix& expected) {
  return (found - expected).norm() / expected.norm();
}

TEST(TexelSolver, RecoversTheCoefficientsOfItsOwnImages) {
  const SideDirections side = directions();
  const SharedLobes shared = lobes();
  for (const float high : {0.0f, 0.03f}) {
    const Relief relief = relief_of(6, 5, high);
    const RowMatrix truth = random_coefficients(relief, 8);
    EXPECT_LT(relative_error(solved(side, shared, relief, truth, 60), truth), 1e-3f) << high;
  }
  // The control: over a relief texels share their images, and one step does not tell them apart.
  const Relief relief = relief_of(6, 5, 0.03f);
  const RowMatrix truth = random_coefficients(relief, 8);
  EXPECT_GT(relative_error(solved(side, shared, relief, truth, 1), truth), 0.1f);
}

TEST(TexelSolver, StaysAtAStartThatIsRight) {
  const SideDirections side = directions();
  const SharedLobes shared = lobes();
  const Relief relief = relief_of(6, 5, 0.03f);
  const RowMatrix truth = random_coefficients(relief, 8);
  const Progress progress;
  TexelSolver solver(side, shared, relief, 2, progress);
  for (size_t v = 0; v < side.view.size(); ++v) solver.add_view(v, images_of(side, shared, relief, truth, v));
  EXPECT_LT(relative_error(solver.solve(truth, 20, nothing), truth), 1e-3f);
}

/// Over a plane texels do not touch, so means of values have the means of coefficients.
TEST(TexelSolver, OfFilteredImagesOfAPlaneFindsFilteredCoefficients) {
  const SideDirections side = directions();
  const SharedLobes shared = lobes();
  const Relief fine = relief_of(6, 4, 0), coarse = relief_of(3, 2, 0);
  const RowMatrix truth = random_coefficients(fine, 8);
  const std::vector<float> half = half_image({truth.data(), static_cast<size_t>(truth.size())}, 6, 4, 8);
  const RowMatrix expected = Eigen::Map<const RowMatrix>(half.data(), 6, 8);
  const Progress progress;
  TexelSolver solver(side, shared, coarse, 2, progress);
  for (size_t v = 0; v < side.view.size(); ++v) {
    LevelImages images = images_of(side, shared, fine, truth, v);
    for (RowMatrix& axis : images.value) {
      const auto lights = static_cast<uint32_t>(axis.cols());
      const std::vector<float> filtered = half_image({axis.data(), static_cast<size_t>(axis.size())}, 6, 4, lights);
      axis = Eigen::Map<const RowMatrix>(filtered.data(), 6, axis.cols());
    }
    images.width = 3;
    images.height = 2;
    solver.add_view(v, images);
  }
  EXPECT_LT(relative_error(solver.solve(RowMatrix::Zero(6, 8), 60, nothing), expected), 1e-3f);
}

TEST(TexelSolver, IsTheSameForAnyNumberOfThreads) {
  const SideDirections side = directions();
  const Relief relief = relief_of(13, 11, 0.02f);  // more than one block of texels
  const RowMatrix truth = random_coefficients(relief, 8);
  EXPECT_EQ(solved(side, lobes(), relief, truth, 5, 1), solved(side, lobes(), relief, truth, 5, 2));
}

TEST(TexelSolver, OfNoCoefficientsHasNone) {
  const SideDirections side = directions();
  const Relief relief = relief_of(2, 2, 0);
  const RowMatrix none(4, 0);
  EXPECT_EQ(solved(side, {{{}}, 1, {}}, relief, none, 3).size(), 0);
}

TEST(RowProducts, AreThoseOfMatrices) {
  constexpr uint32_t kCount = 7, kStride = 48;
  AlignedArray<float> rows(kCount * kStride), coefficient(3 * kStride), value(3 * kCount), sum(3 * kStride);
  RandomStream random(14, 0, 0);
  const auto fill = [&](AlignedArray<float>& floats, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) floats.data()[i] = random.next() - 0.5f;
  };
  fill(rows, kCount * kStride);
  fill(coefficient, 3 * kStride);
  const Eigen::MatrixXd matrix = Eigen::Map<RowMatrix>(rows.data(), kCount, kStride).cast<double>();
  const Eigen::MatrixXd vectors = Eigen::Map<RowMatrix>(coefficient.data(), 3, kStride).cast<double>();
  test::on_every_simd_target([&] {
    rows_times(rows.data(), kCount, kStride, coefficient.data(), value.data());
    const Eigen::MatrixXd products = matrix * vectors.transpose();
    EXPECT_LT((Eigen::Map<RowMatrix>(value.data(), kCount, 3).cast<double>() - products).norm(), 1e-5);
    times_rows(rows.data(), kCount, kStride, value.data(), sum.data());
    EXPECT_LT((Eigen::Map<RowMatrix>(sum.data(), 3, kStride).cast<double>() - products.transpose() * matrix).norm(),
              1e-4);
  });
}

}  // namespace
}  // namespace velour::texel_solver_test
