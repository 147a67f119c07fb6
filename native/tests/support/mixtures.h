// Mixtures for tests, and the scalar reference in double.
#pragma once

#include <array>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "math/srbf/lobe_mixture.h"

namespace velour::test {

inline std::vector<float> bandwidth_grid(Kernel kernel) {
  if (kernel == Kernel::gaussian) return {0, 1e-4f, 1e-2f, 1, 7, 44.5f, 88.5f, 1e3f, 1e4f, 1e5f, 1e6f};
  return {0, 1e-4f, 0.1f, 0.5f, 0.9f, 0.99f, 0.9999f, 1 - 0x1p-24f};
}

/// `lobes` lobes of random center over the sphere and bandwidth log-uniform over the kernel's range.
inline LobeMixture random_mixture(Kernel kernel, int lobes, uint64_t seed, float share = 0.05f) {
  LobeMixture mixture;
  mixture.clear(kernel);
  RandomStream random(seed, 0, 0);
  const auto centers = sphere_fibonacci(std::max(lobes, 1));
  for (int j = 0; j < lobes; ++j) {
    const float exponent = random.next();
    const float bandwidth =
        kernel == Kernel::gaussian ? 0.1f * std::pow(1e5f, exponent) : 1 - std::pow(0.01f, exponent);
    mixture.add(centers[static_cast<size_t>(j)], bandwidth, {random.next(), random.next(), random.next()});
  }
  mixture.finish(share);
  return mixture;
}

struct MixtureValue {
  std::array<double, 3> value{};
  double pdf = 0;
};

/// What eval_mixture computes, in double and one lobe after the other.
inline MixtureValue reference_mixture(const LobeMixture& m, const Vec3& w) {
  MixtureValue sum;
  const double cosine = std::max(0.0, double(w.z));
  sum.value = {m.diffuse_r * cosine, m.diffuse_g * cosine, m.diffuse_b * cosine};
  sum.pdf = m.cosine_share * cosine / kPiD;
  for (int j = 0; j < m.count; ++j) {
    const double d = one_minus_dot(Vec3d(w), Vec3d(m.x[j], m.y[j], m.z[j]));
    const double kernel = kernel_value(m.kernel, m.bandwidth[j], d);
    sum.value[0] += m.r[j] * kernel;
    sum.value[1] += m.g[j] * kernel;
    sum.value[2] += m.b[j] * kernel;
    sum.pdf += m.density[j] * kernel;
  }
  return sum;
}

inline DirectionBatch batch_of(std::span<const Vec3> directions) {
  DirectionBatch batch;
  for (const Vec3& w : directions) batch.push(w);
  batch.pad();
  return batch;
}

}  // namespace velour::test
