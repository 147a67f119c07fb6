// Means with their error, and the z-test between two of them.
#pragma once

#include <cmath>
#include <cstdint>

namespace velour::test {

/// Welford's running mean and variance.
class RunningMean {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / static_cast<double>(count_);
    sum_sq_ += delta * (x - mean_);
  }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? sum_sq_ / static_cast<double>(count_ - 1) : 0.0; }
  double standard_error() const { return std::sqrt(variance() / static_cast<double>(count_)); }
  int64_t count() const { return count_; }

 private:
  int64_t count_ = 0;
  double mean_ = 0, sum_sq_ = 0;
};

/// Two-sided p-value of the difference of two independent means with standard errors.
inline double z_test(double mean_a, double error_a, double mean_b, double error_b) {
  const double spread = std::sqrt(error_a * error_a + error_b * error_b);
  if (spread == 0.0) return mean_a == mean_b ? 1.0 : 0.0;
  return std::erfc(std::abs(mean_a - mean_b) / spread / std::sqrt(2.0));
}

}  // namespace velour::test
