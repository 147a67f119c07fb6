// What the model files of BTFs that are made of sides share.
#pragma once

#include "btf/sides.h"
#include "btf/srbf_btf.h"
#include "model/btf_parts.h"

namespace velour {

/// "btf.side.S.": what the names of a side's parts begin with.
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
/// At most four sides of their own and three shared ones, which name sides that there are.
SideTable read_side_table(const ModelFields& fields);

/// That of a body with `sides` and `shared`.
template <typename Btf>
SideTable side_table(const Btf& btf) {
  SideTable table{{}, btf.shared};
  for (const auto& side : btf.sides) table.sides.push_back({side.view_below, side.light_below});
  return table;
}

/// Bytes [texel][coefficient] as a part of pictures, one a coefficient, that a viewer shows; and back.
Tensor byte_maps(const std::vector<uint8_t>& bytes, uint64_t coefficients, uint32_t width, uint32_t height);
std::vector<uint8_t> read_byte_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                    uint32_t width, uint32_t height);

/// What bytes stand for: a part of `shape` and two numbers each, the least value and the step.
Tensor scales_tensor(const std::vector<ByteScale>& scales, std::vector<uint64_t> shape);
std::vector<ByteScale> read_scales(const ModelFields& fields, const std::string& part, std::vector<uint64_t> shape);

}  // namespace velour
