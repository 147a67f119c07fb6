#include "support/statistics.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "support/artifacts.h"
#include "support/significance.h"

namespace velour::test {

Difference difference(const Estimate& a, const Estimate& b) {
  const double va = a.error * a.error, vb = b.error * b.error, spread = va + vb;
  if (spread == 0) return {a.mean == b.mean ? 0 : std::numeric_limits<double>::infinity(), a.degrees};
  // Welch and Satterthwaite: the degrees of freedom of a sum of two estimated variances.
  const double inverse = va / spread * (va / spread) / a.degrees + vb / spread * (vb / spread) / b.degrees;
  return {(a.mean - b.mean) / std::sqrt(spread), 1 / inverse};
}

double z_test(const Estimate& a, const Estimate& b) {
  if (!std::isfinite(a.mean) || !std::isfinite(b.mean)) return 0;
  const Difference d = difference(a, b);
  return std::isinf(d.z) ? 0.0 : student_tail(d.z, d.degrees);
}

void ZTests::add(const std::string& name, const Estimate& found, const Estimate& expected, Evidence evidence) {
  comparisons_.push_back({name, found, expected, std::move(evidence), z_test(found, expected)});
}

double ZTests::level_of_each() const { return sidak_level(level_, static_cast<int>(comparisons_.size())); }

::testing::AssertionResult ZTests::agree() const {
  std::vector<const Comparison*> rejected;
  for (const Comparison& c : comparisons_) {
    if (!(c.p > level_of_each())) rejected.push_back(&c);
  }
  if (comparisons_.empty()) return ::testing::AssertionFailure() << "the list is empty";
  if (rejected.empty()) return ::testing::AssertionSuccess();
  std::stable_sort(rejected.begin(), rejected.end(), [](const auto* a, const auto* b) { return a->p < b->p; });
  std::ostringstream text;
  text << rejected.size() << " of " << comparisons_.size() << " comparisons differ at level " << level_of_each()
       << " each:";
  std::set<std::string> evidence;
  for (const Comparison* c : rejected) {
    text << "\n  " << c->name << ": found " << c->found.mean << " +- " << c->found.error << ", expected "
         << c->expected.mean << " +- " << c->expected.error << ", p " << c->p;
    if (c->evidence) evidence.insert(c->evidence());
  }
  text << "\nall of them in " << write();
  for (const std::string& e : evidence) text << "\n" << e;
  return ::testing::AssertionFailure() << text.str();
}

::testing::AssertionResult ZTests::differ() const {
  double least = 1;
  for (const Comparison& c : comparisons_) least = std::min(least, c.p);
  if (least < sidak_level(kControlLevel, static_cast<int>(std::max(comparisons_.size(), size_t{1})))) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "the control is not seen: the least of " << comparisons_.size()
                                       << " p-values is " << least;
}

double ZTests::smallest_bias(const std::string& name) const {
  for (const Comparison& c : comparisons_) {
    if (c.name != name) continue;
    const double degrees = difference(c.found, c.expected).degrees;
    const double steps = student_quantile(level_of_each(), degrees) + student_quantile(0.02, degrees);
    return steps * std::hypot(c.found.error, c.expected.error) / std::abs(c.expected.mean);
  }
  throw std::invalid_argument("no comparison is called " + name);
}

std::string ZTests::write() const {
  const auto path = artifact_path("z-tests.csv");
  std::ofstream file(path);
  file << "name,found,error_found,expected,error_expected,z,p\n";
  for (const Comparison& c : comparisons_) {
    file << c.name << ',' << c.found.mean << ',' << c.found.error << ',' << c.expected.mean << ',' << c.expected.error
         << ',' << difference(c.found, c.expected).z << ',' << c.p << '\n';
  }
  return path.string();
}

}  // namespace velour::test
