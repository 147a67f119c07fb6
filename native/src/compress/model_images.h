// Pictures of a BTF's model, whatever its kind.
#pragma once

#include "compress/btf_compare.h"
#include "model/model.h"

namespace velour {

/// f of every texel of the finest level for a pair of directions. `body`, a BTF's, must outlive it.
BtfImages images_of(const ModelBody& body);

}  // namespace velour
