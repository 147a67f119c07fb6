// Parts shared by the model files of BTFs that consist of sides.
#pragma once

#include "btf/sides.h"
#include "btf/srbf_btf.h"
#include "model/btf_parts.h"

namespace velour {

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
