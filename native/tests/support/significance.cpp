#include "support/significance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace velour::test {

namespace {

/// Continued fraction of the incomplete beta function by Lentz's method; converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double x, double a, double b) {
  double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m < 1000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / (1 + even * d);
    c = 1 + even / c;
    fraction *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / (1 + odd * d);
    c = 1 + odd / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return fraction;
}

double regularised_beta(double x, double a, double b) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;
}

}  // namespace

double sidak_level(double level, int tests) { return -std::expm1(std::log1p(-level) / tests); }

double suite_level(double level) {
  return sidak_level(level, ::testing::UnitTest::GetInstance()->current_test_suite()->total_test_count());
}

uint64_t seed_of_test() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : std::string(info->test_suite_name()) + '.' + info->name()) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

double chi_square_tail(double statistic, int degrees_of_freedom) {
  const double a = 0.5 * degrees_of_freedom, x = 0.5 * statistic;
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {  // series of the lower function, then its complement
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > 1e-16 * sum; ++n) sum += term *= x / n;
    return std::max(0.0, 1 - front * sum);
  }
  // Continued fraction of the upper function, by Lentz's method.
  double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int i = 1; i < 10000; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * fraction;
}

double student_tail(double t, double degrees) {
  if (degrees > 1e6) return std::erfc(std::abs(t) / std::sqrt(2.0));
  return regularised_beta(degrees / (degrees + t * t), 0.5 * degrees, 0.5);
}

double student_quantile(double p, double degrees) {
  double low = 0, high = 1;
  while (student_tail(high, degrees) > p) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (student_tail(middle, degrees) > p ? low : high) = middle;
  }
  return high;
}

}  // namespace velour::test
