// From the numbers of a source to the apparent BRDF. Internal to btf/.
#pragma once

#include <string>

#include "btf/load_btf.h"

namespace velour {

/// f = number * factor, and over |cos(theta_l)| where the number has that cosine in it.
struct ValueScale {
  double factor = 1;
  bool cosine = false;

  float of(const PolarAngles& light) const;
  /// For `info`: "f = number / (pi cos(theta_l))".
  std::string text() const;
};

/// `automatic` is not one of them.
ValueScale scale_of(BtfValues values);

}  // namespace velour
