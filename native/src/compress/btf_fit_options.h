// What every fit of a BTF is asked for.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"

namespace velour {

struct BtfFitOptions {
  uint64_t bytes = 0;  // of all that is fitted, at most; 0: a two-hundredth of the measurement, or the method's least
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;  // 0: all
};

}  // namespace velour
