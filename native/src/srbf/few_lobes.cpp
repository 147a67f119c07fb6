#include "srbf/few_lobes.h"

#include <algorithm>

#include "srbf/kernel.h"

namespace velour {
namespace {

std::vector<GaussianLobe> listed(const GaussianLobes& lobes) {
  std::vector<GaussianLobe> list;
  for (size_t k = 0; k < lobes.size(); ++k) {
    list.push_back({{lobes.x[k], lobes.y[k], lobes.z[k]}, lobes.bandwidth[k], lobes.amplitude[k]});
  }
  return list;
}

/// Integral over the sphere of the product of two sums.
double inner(const std::vector<GaussianLobe>& first, const std::vector<GaussianLobe>& second) {
  double sum = 0;
  for (const GaussianLobe& a : first) {
    for (const GaussianLobe& b : second) {
      sum += static_cast<double>(a.amplitude) * static_cast<double>(b.amplitude) *
             kernel_convolution(Kernel::gaussian, Vec3d(a.center), static_cast<double>(a.bandwidth), Vec3d(b.center),
                                static_cast<double>(b.bandwidth));
    }
  }
  return sum;
}

}  // namespace

std::vector<GaussianLobe> few_lobes(const GaussianLobes& lobes, double tolerance, int most) {
  constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};
  const LobeTree tree(lobes);
  const std::vector<GaussianLobe> all = listed(lobes);
  const double whole_sq = inner(all, all);
  std::vector<GaussianLobe> few;
  for (int count = 1; count <= most; ++count) {
    few = tree.cut(kEverywhere, count);
    const double error_sq = whole_sq - 2 * inner(all, few) + inner(few, few);
    if (error_sq <= tolerance * tolerance * whole_sq) break;
  }
  std::stable_sort(few.begin(), few.end(), [](auto& a, auto& b) { return a.bandwidth < b.bandwidth; });
  return few;
}

}  // namespace velour
