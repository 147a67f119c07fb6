// Highway compiles this file once for each instruction set.
#include "btf/model/srbf_evaluator.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/model/byte_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_FLATTEN void add_bytes(const ByteTexels& texels, const Vec2& texel, float weight, const float* step, float* to) {
  const hn::CappedTag<float, kByteRowPadding> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<uint8_t, decltype(d)> du;
  const BilinearTexels corner = bilinear_at(texel, texels.width, texels.height);
  const uint8_t* row[4];
  for (size_t i = 0; i < 4; ++i) row[i] = texels.bytes + size_t{corner.index[i]} * texels.stride;
  const auto bytes = [&](size_t i, uint32_t k) {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, row[i] + k)));
  };
  const auto w = [&](size_t i) { return hn::Set(d, weight * corner.weight[i]); };
  for (uint32_t k = 0; k < texels.stride; k += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto low = hn::MulAdd(bytes(1, k), w(1), hn::Mul(bytes(0, k), w(0)));
    const auto high = hn::MulAdd(bytes(3, k), w(3), hn::Mul(bytes(2, k), w(2)));
    hn::Store(hn::MulAdd(hn::Add(low, high), hn::Load(d, step + k), hn::Load(d, to + k)), d, to + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(add_bytes);

void add_bilinear_bytes(const ByteTexels& texels, const Vec2& texel, float weight, const float* step, float* to) {
  VELOUR_SIMD_DISPATCH(add_bytes)(texels, texel, weight, step, to);
}

}  // namespace velour
#endif
