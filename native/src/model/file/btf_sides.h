// Parts shared by the model files of BTFs that consist of sides.
#pragma once

#include <string>
#include <vector>
#include "btf/model/factored_btf.h"
#include "btf/model/srbf_btf.h"
#include "model/file/model_fields.h"

namespace velour {

// Parts shared by the model files of all BTFs.

/// Description of a BTF without its coefficients.
struct BtfFrame {
  PairLayout layout;
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};  // columns
};

void write_btf_frame(const BtfFrame& frame, TensorFile& file);
/// Throws Error(bad_data) for layouts that leave out pairs.
BtfFrame read_btf_frame(const ModelFields& fields);

/// Throws Error(bad_data) unless `tensor`, a part of the file, has this shape.
void expect_shape(const ModelFields& fields, const std::string& part, const Tensor& tensor,
                  const std::vector<uint64_t>& shape);
/// Reads a part of this shape as half floats, all of which must be finite.
std::vector<HalfBits> shaped_halves(const ModelFields& fields, const std::string& part,
                                    const std::vector<uint64_t>& shape);
/// Makes a part of half floats.
Tensor tensor_of(const std::vector<HalfBits>& halves, const std::vector<uint64_t>& shape);

/// Transposes [from][to] to [to][from].
template <class Value>
std::vector<Value> transposed(const std::vector<Value>& values, size_t to) {
  std::vector<Value> out(values.size());
  const size_t from = values.size() / to;
  for (size_t f = 0; f < from; ++f) {
    for (size_t t = 0; t < to; ++t) out[t * from + f] = values[f * to + t];
  }
  return out;
}

/// Converts values [texel][coefficient] to a part with one image per coefficient, and back.
Tensor maps_tensor(const std::vector<HalfBits>& values, uint64_t coefficients, uint32_t width, uint32_t height);
std::vector<HalfBits> read_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                uint32_t width, uint32_t height);

/// "btf.side.S.", the prefix of the names of a side's parts.
std::string side_prefix(size_t number);

/// The parts btf.sides and btf.shared.
struct SideTable {
  struct Place {
    bool view_below, light_below;
  };
  std::vector<Place> sides;
  std::vector<SharedSide> shared;
};

void write_side_table(const SideTable& table, TensorFile& file);
/// Accepts at most four own sides and three shared ones, which must refer to existing sides.
SideTable read_side_table(const ModelFields& fields);

/// The side table of a model body with `sides` and `shared`.
template <typename Btf>
SideTable side_table(const Btf& btf) {
  SideTable table{{}, btf.shared};
  for (const auto& side : btf.sides) table.sides.push_back({side.view_below, side.light_below});
  return table;
}

/// Converts bytes [texel][coefficient] to a part with one image per coefficient, which image viewers show, and back.
Tensor byte_maps(const std::vector<uint8_t>& bytes, uint64_t coefficients, uint32_t width, uint32_t height);
std::vector<uint8_t> read_byte_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                    uint32_t width, uint32_t height);

/// The scales of bytes as a part of `shape` with two numbers each: the least value and the step.
Tensor scales_tensor(const std::vector<ByteScale>& scales, std::vector<uint64_t> shape);
std::vector<ByteScale> read_scales(const ModelFields& fields, const std::string& part, std::vector<uint64_t> shape);

}  // namespace velour
