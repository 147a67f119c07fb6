// Levels, tail probabilities and seeds: what every statistical verdict of the tests rests on.
#pragma once

#include <cstdint>

namespace velour::test {

/// Level of each of `tests` tests so that the whole list has level `level` (Sidak).
double sidak_level(double level, int tests);

/// The same for a verdict of which each test of the running suite gives one: a parametrised suite is one list.
double suite_level(double level = 0.01);

/// A fixed seed that the name of the running test decides, so that the cases of a list are independent of each other
/// and none changes when another is added.
uint64_t seed_of_test();

/// Probability that chi-square with `degrees_of_freedom` exceeds `statistic`: the regularised upper gamma function.
double chi_square_tail(double statistic, int degrees_of_freedom);

/// Probability that Student's t with `degrees` of freedom exceeds |t| on either side; infinite `degrees`: the normal
/// distribution. The regularised incomplete beta function.
double student_tail(double t, double degrees);

/// The t of which student_tail is `p`, 0 < p < 1.
double student_quantile(double p, double degrees);

}  // namespace velour::test
