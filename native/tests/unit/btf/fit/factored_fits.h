// What the tests of fits as sums of products share.
#pragma once

#include <algorithm>
#include <vector>

#include "btf/fit/btf_compare.h"
#include "btf/fit/svd/svd_fit.h"
#include "math/sphere/random.h"
#include "support/memory_btf.h"
#include "support/singular_values.h"

namespace velour::test {

inline const TexelGrid kGrid{12, 10};

inline PairLayout small_layout() { return {ring_directions(30, 5), ring_directions(50, 7)}; }

struct FactoredFit {
  FactoredBtf btf;
  uint64_t not_finite;
};

template <class Fitter>
FactoredFit fit(const BtfMeasurement& btf, const BtfFitOptions& options) {
  Progress progress;
  FitCheckpoint none;
  Fitter fitter(btf, options, none, progress);
  return {std::get<FactoredBtf>(fitter.fit(fitter.largest())), fitter.not_finite()};
}

inline BtfErrors errors_of(const FactoredBtf& model, const BtfMeasurement& btf) {
  const FactoredImages images(model);
  const auto decode = [&](const DirectionPair& pair, std::vector<float>& rgb) { images.image(pair, rgb); };
  Progress progress;
  return compare_btf(btf, decode, {}, 2, progress);
}

/// Every entry its own.
inline Rgb noise(const DirectionPair& pair, uint32_t x, uint32_t y) {
  RandomStream random(static_cast<uint64_t>(pair.wl.x * 1e6f + pair.wv.y * 1e3f + 2e6f), x, y);
  const float r = random.next(), g = random.next();
  return {r, g, random.next()};
}

/// All of f, [pair][texel][channel].
inline std::vector<float> values_of(const BtfMeasurement& btf) {
  std::vector<HalfBits> halves(btf.layout().pairs() * btf.grid().texels() * 3);
  std::vector<float> f(halves.size());
  btf.read_pairs(0, btf.layout().pairs(), halves);
  halves_to_floats(halves, f);
  return f;
}

/// Rows [first, first + count) of the matrix pairs x texels along a direction in RGB.
inline Eigen::MatrixXd plane_of(const std::vector<float>& f, const Vec3& axis, Eigen::Index first, Eigen::Index count,
                                Eigen::Index texels) {
  Eigen::MatrixXd matrix(count, texels);
  for (Eigen::Index p = 0; p < count; ++p) {
    for (Eigen::Index t = 0; t < texels; ++t) {
      const float* rgb = f.data() + ((first + p) * texels + t) * 3;
      matrix(p, t) = static_cast<double>(glm::dot(axis, Vec3(rgb[0], rgb[1], rgb[2])));
    }
  }
  return matrix;
}

/// Appends the squares of a matrix' singular values.
inline void add_energies(const Eigen::MatrixXd& matrix, std::vector<double>& energy) {
  for (const double value : singular_values(matrix)) energy.push_back(value * value);
}

/// Squared error of a model at all pairs.
inline double squared_error(const FactoredBtf& model, const BtfMeasurement& btf) {
  const std::vector<float> f = values_of(btf);
  const FactoredImages images(model);
  double error = 0;
  std::vector<float> image;
  for (uint64_t p = 0; p < btf.layout().pairs(); ++p) {
    images.image(btf.layout().directions(p), image);
    for (size_t i = 0; i < image.size(); ++i) {
      const auto difference = static_cast<double>(image[i] - f[p * image.size() + i]);
      error += difference * difference;
    }
  }
  return error;
}

/// Sum of all but the largest `kept` of `energy`, the squares of singular values.
inline double left_out(std::vector<double> energy, size_t kept) {
  std::sort(energy.rbegin(), energy.rend());
  double left = 0;
  for (size_t k = kept; k < energy.size(); ++k) left += energy[k];
  return left;
}

}  // namespace velour::test
