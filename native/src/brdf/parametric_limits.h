// Ranges of the control values of the parametric model. A spline's value lies between its control values, so a model
// within these ranges stays within them at every view. Fits stay well inside; a file outside is refused.
#pragma once

#include "brdf/parametric_brdf.h"
#include "sphere/vec.h"

namespace velour {

struct ParameterRange {
  float least, most;
  const char* name;

  bool holds(float value) const { return value >= least && value <= most; }  // NaN: no
};

/// Bandwidths of 1e-5 to 1e9, coefficients of e^-40 (nothing) to 1e12 1/sr, tilts up to half a turn, stretches up to
/// e^6 along an axis.
constexpr ParameterRange parameter_range(int parameter) {
  switch (parameter) {
    case ParametricBrdf::kLogBandwidth:
      return {-11.5f, 20.72f, "logarithm of the bandwidth"};
    case ParametricBrdf::kLogRed:
    case ParametricBrdf::kLogGreen:
    case ParametricBrdf::kLogBlue:
      return {-40.0f, 27.6f, "logarithm of the coefficient"};
    case ParametricBrdf::kTiltX:
    case ParametricBrdf::kTiltY:
      return {-kPi, kPi, "tilt in radians"};
    default:
      return {-6.0f, 6.0f, "stretch"};
  }
}

}  // namespace velour
