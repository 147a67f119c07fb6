// Images of a BTF's model, for all methods.
#pragma once

#include "compress/btf_compare.h"
#include "model/model.h"

namespace velour {

/// Computes f of every texel of the finest level for a pair. `body` must be of a BTF and outlive the result.
BtfImages images_of(const ModelBody& body);

}  // namespace velour
