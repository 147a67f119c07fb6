// The factors of clustered tensors as floats.
#pragma once

#include <vector>

#include "btf/tensor_btf.h"

namespace velour {

/// TensorBtfCluster as floats, with colors in linear Rec. 709 instead of along the axes.
struct TensorFactors {
  TensorFactors(const TensorBtf& btf, const TensorBtfCluster& cluster);
  std::vector<float> view;   // [view][rank]
  std::vector<float> light;  // [light][rank]
  std::vector<float> color;  // [channel][rank]
  std::vector<float> core;   // [texel rank][view rank][light rank][color rank]
};

/// Heights of a level that has a relief.
std::vector<float> heights_of(const TensorLevel& level);

}  // namespace velour
