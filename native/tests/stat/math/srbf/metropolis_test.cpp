// The dissertation offers inversion or Metropolis-Hastings for the zenith angle [T09 7.12]. We ship inversion; the
// chain, which knows the kernel's value alone and neither its integral nor its inverse, is an independent witness for
// it.
#include <gtest/gtest.h>

#include <vector>

#include "math/sphere/random.h"
#include "math/srbf/kernel.h"
#include "support/chi_square.h"

namespace velour::metropolis_test {
namespace {

/// Every `kThinning`th state of a random walk in log d whose density in d is the kernel.
std::vector<double> metropolis_zeniths(Kernel kernel, double bandwidth, double start, size_t count) {
  constexpr int kThinning = 40;
  RandomStream random(17, 0, 0);
  double d = start;
  std::vector<double> states;
  while (states.size() < count) {
    for (int i = 0; i < kThinning; ++i) {
      const double proposed = d * std::exp(4.0 * (random.next() - 0.5));
      if (proposed >= 2) continue;
      // A step even in log d is uneven in d by the ratio of the two.
      const double ratio =
          kernel_value(kernel, bandwidth, proposed) * proposed / (kernel_value(kernel, bandwidth, d) * d);
      if (random.next() < ratio) d = proposed;
    }
    states.push_back(d);
  }
  return states;
}

/// p-value of the hypothesis that u of the states is uniform: cells between quantiles hold equal counts.
double uniformity(const std::vector<double>& states, Kernel kernel, double bandwidth) {
  constexpr int kCells = 50;
  std::vector<double> count(kCells, 0.0);
  for (const double d : states) {
    int cell = 0;
    while (cell + 1 < kCells && d < kernel_sample(kernel, bandwidth, static_cast<double>(cell + 1) / kCells)) ++cell;
    ++count[static_cast<size_t>(cell)];
  }
  const double expected = static_cast<double>(states.size()) / kCells;
  double statistic = 0;
  for (const double n : count) statistic += (n - expected) * (n - expected) / expected;
  return test::chi_square_tail(statistic, kCells - 1);
}

TEST(Metropolis, AgreesWithTheInversion) {
  struct Case {
    Kernel kernel;
    double bandwidth, typical_d;
  };
  for (const Case& c : {Case{Kernel::gaussian, 0.5, 1},
                        {Kernel::gaussian, 40, 0.02},
                        {Kernel::gaussian, 1e5, 1e-5},
                        {Kernel::abel_poisson, 0.3, 0.5},
                        {Kernel::abel_poisson, 0.95, 2e-3}}) {
    const auto states = metropolis_zeniths(c.kernel, c.bandwidth, c.typical_d, 40'000);
    EXPECT_GT(uniformity(states, c.kernel, c.bandwidth), test::sidak_level(0.01, 5)) << c.bandwidth;
    const double wrong = c.kernel == Kernel::gaussian ? 1.2 * c.bandwidth : 0.9 * c.bandwidth;
    EXPECT_LT(uniformity(states, c.kernel, wrong), 0.01) << c.bandwidth;
  }
}

}  // namespace
}  // namespace velour::metropolis_test
