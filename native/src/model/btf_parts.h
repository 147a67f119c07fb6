// What the model files of all BTFs share.
#pragma once

#include <string>
#include <vector>

#include "btf/factored_btf.h"
#include "model/model_fields.h"

namespace velour {

/// What is known of a BTF beside its coefficients.
struct BtfFrame {
  PairLayout layout;
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};  // columns
};

void write_btf_frame(const BtfFrame& frame, TensorFile& file);
/// Refuses layouts that leave out pairs.
BtfFrame read_btf_frame(const ModelFields& fields);

/// Refuses `tensor`, a part of the file, unless it has this shape.
void expect_shape(const ModelFields& fields, const std::string& part, const Tensor& tensor,
                  const std::vector<uint64_t>& shape);
/// A part of this shape as half floats, all finite.
std::vector<HalfBits> shaped_halves(const ModelFields& fields, const std::string& part,
                                    const std::vector<uint64_t>& shape);
/// A part of half floats.
Tensor tensor_of(const std::vector<HalfBits>& halves, const std::vector<uint64_t>& shape);

/// [from][to] to [to][from].
template <class Value>
std::vector<Value> transposed(const std::vector<Value>& values, size_t to) {
  std::vector<Value> out(values.size());
  const size_t from = values.size() / to;
  for (size_t f = 0; f < from; ++f) {
    for (size_t t = 0; t < to; ++t) out[t * from + f] = values[f * to + t];
  }
  return out;
}

/// Values [texel][coefficient] as a part of pictures, one a coefficient, and back.
Tensor maps_tensor(const std::vector<HalfBits>& values, uint64_t coefficients, uint32_t width, uint32_t height);
std::vector<HalfBits> read_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                uint32_t width, uint32_t height);

}  // namespace velour
