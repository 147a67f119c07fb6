// Options of all BTF fits.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"

namespace velour {

struct BtfFitOptions {
  /// Maximum size of the model. 0: the method's default fraction of the measurement (singular values 1:200, others
  /// 1:400), but at least its minimum; with a tolerance, as much as it takes.
  uint64_t bytes = 0;
  double tolerance = 0;  // maximum relative L2 error of companded values (BtfErrors); 0: none, use all bytes
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;      // 0: all
  uint64_t memory = 0;  // maximum bytes that the fit holds at once; 0: no limit
  bool relief = true;   // texels lie on the structure's surface, if the BTF has one, or else on the reference plane;
                        // ignored by singular values
  // Clustered tensors only:
  uint32_t clusters = 0;  // per side; 0: automatic (shape_search.h)
  uint32_t members = 0;   // clusters per texel; 0: automatic
};

}  // namespace velour
