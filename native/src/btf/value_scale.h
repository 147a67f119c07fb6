// Conversion of source values to the apparent BRDF. Internal to btf/.
#pragma once

#include <string>

#include "btf/load_btf.h"

namespace velour {

/// f = number * factor, divided by |cos(theta_l)| if the number includes that cosine.
struct ValueScale {
  double factor = 1;
  bool cosine = false;

  float of(const PolarAngles& light) const;
  /// For `info`: "f = number / (pi cos(theta_l))".
  std::string text() const;
};

/// `values` must not be `automatic`.
ValueScale scale_of(BtfValues values);

}  // namespace velour
