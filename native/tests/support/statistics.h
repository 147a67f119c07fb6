// Means with their errors, and the test of two of them: ZTests is the one list of comparisons that the tests judge by.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace velour::test {

/// A mean and its standard error, itself estimated with so many degrees of freedom (infinite: it is known).
struct Estimate {
  double mean = 0, error = 0, degrees = std::numeric_limits<double>::infinity();
};

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
  Estimate estimate() const { return {mean(), standard_error(), static_cast<double>(count_ - 1)}; }

 private:
  int64_t count_ = 0;
  double mean_ = 0, sum_sq_ = 0;
};

/// Difference of two independent means over its standard error, and that error's degrees of freedom (Welch).
struct Difference {
  double z, degrees;
};
Difference difference(const Estimate& a, const Estimate& b);

/// Two-sided p-value of the hypothesis that the expectations are equal. Errors of few degrees of freedom have Student's
/// heavier tails, so it stays a p-value for a handful of renders.
double z_test(const Estimate& a, const Estimate& b);

/// A list of comparisons of one level as a whole: each is judged at Sidak's share of it.
class ZTests {
 public:
  /// Lists that are one of several, in a parametrised suite, give the level that Sidak leaves to each.
  explicit ZTests(double level = 0.01) : level_(level) {}

  /// What a control must fall below: nothing that chance would bring in a thousand lists.
  static constexpr double kControlLevel = 1e-5;

  /// Writes evidence of a failed comparison and returns where it lies.
  using Evidence = std::function<std::string()>;

  void add(const std::string& name, const Estimate& found, const Estimate& expected, Evidence evidence = {});
  double level_of_each() const;

  /// Success when no comparison is rejected. A failure names those that are, the worst first, writes the whole list as
  /// the artifact z-tests.csv and asks the failed comparisons for their evidence.
  ::testing::AssertionResult agree() const;

  /// For negative controls: success when at least one comparison of the list is rejected as a list of level
  /// kControlLevel. Leaves no files.
  ::testing::AssertionResult differ() const;

  /// Relative bias of the mean found that the comparison `name` rejects in 99 of 100 cases, at the level that it has in
  /// this list.
  double smallest_bias(const std::string& name) const;

 private:
  struct Comparison {
    std::string name;
    Estimate found, expected;
    Evidence evidence;
    double p;
  };
  std::string write() const;
  double level_;
  std::vector<Comparison> comparisons_;
};

}  // namespace velour::test
