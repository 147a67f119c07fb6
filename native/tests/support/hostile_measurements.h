// Measurements that break fits, each with the truth behind it and the warning that a user must be given. Every kind of
// model is held against all of them.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "support/analytic_measurement.h"

namespace velour::test {

/// One hostile case.
struct HostileCase {
  std::string name;
  std::shared_ptr<const Measurement> given;  // what the fit reads
  AnalyticMeasurement::Formula truth;        // f that a good fit would find: without noise, holes and sentinels
  std::vector<std::string> told;             // regular expressions, each found in the JSON of the fit's warnings
  std::string refused = {};                  // part of the refusal's sentence; empty: the fit must succeed
  AnalyticMeasurement::Coverage known = {};  // where the truth can be asked for; empty: everywhere
};

std::vector<HostileCase> hostile_cases();

inline std::ostream& operator<<(std::ostream& out, const HostileCase& hostile) { return out << hostile.name; }

/// f cos of a mirror's highlight: a Gaussian of `bandwidth` about the mirror direction over a dim diffuse base.
/// Reciprocal, of albedo 0.9 away from grazing.
AnalyticMeasurement::Formula near_mirror(double bandwidth);

/// Light is sent back to where it came from: a Gaussian about wv.
AnalyticMeasurement::Formula retro_reflector(double bandwidth);

/// `f` with Gaussian noise of `deviation` relative to the value, constant in cells of about a degree as in a table.
AnalyticMeasurement::Formula noisy(AnalyticMeasurement::Formula f, double deviation);

AnalyticMeasurement::Formula scaled(AnalyticMeasurement::Formula f, float by);

}  // namespace velour::test
