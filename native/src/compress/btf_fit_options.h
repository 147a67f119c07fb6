// What every fit of a BTF is asked for.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"

namespace velour {

struct BtfFitOptions {
  /// Of all that is fitted, at most; 0: the method's usual part of the measurement (singular values 1:200, the others
  /// 1:400), or its least - with a tolerance, whatever that takes.
  uint64_t bytes = 0;
  double tolerance = 0;  // relative L2 error of companded values that is looked for (BtfErrors); 0: none, all bytes
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;      // 0: all
  uint64_t memory = 0;  // bytes that the fit may hold at once; 0: no limit
  bool relief = true;   // texels are of the structure's surface, where the BTF knows it, or of the reference plane;
                        // singular values know none
  // Of clustered tensors:
  uint32_t clusters = 0;  // of a side; 0: what leaves least (shape_search.h)
  uint32_t members = 0;   // clusters that a texel is made of; 0: the same
};

}  // namespace velour
