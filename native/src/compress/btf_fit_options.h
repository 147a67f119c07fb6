// What every fit of a BTF is asked for.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"

namespace velour {

struct BtfFitOptions {
  /// Of all that is fitted, at most; 0: the method's usual part of the measurement (SRBFs 1:400, singular values
  /// 1:200), or its least - with a tolerance, whatever that takes.
  uint64_t bytes = 0;
  double tolerance = 0;  // relative L2 error of companded values that is looked for (BtfErrors); 0: none, all bytes
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;      // 0: all
  uint64_t memory = 0;  // bytes that the fit may hold at once; 0: no limit
};

}  // namespace velour
