// Highway compiles this file once for each instruction set.
#include "btf/byte_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/byte_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_FLATTEN void add_bytes(const ByteTexels& texels, const Vec2& place, float weight, const float* step, float* to) {
  const hn::CappedTag<float, kByteRowPadding> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<uint8_t, decltype(d)> du;
  const BilinearTexels corner = bilinear_texels(place, texels.width, texels.height);
  const auto weighted = [&](size_t i, uint32_t k) {
    const uint8_t* const row = texels.bytes + size_t{corner.index[i]} * texels.stride;
    const auto bytes = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, row + k)));
    return hn::Mul(bytes, hn::Set(d, weight * corner.weight[i]));
  };
  for (uint32_t k = 0; k < texels.stride; k += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto sum = hn::Add(hn::Add(weighted(0, k), weighted(1, k)), hn::Add(weighted(2, k), weighted(3, k)));
    hn::Store(hn::MulAdd(sum, hn::Load(d, step + k), hn::Load(d, to + k)), d, to + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(add_bytes);

void add_bilinear_bytes(const ByteTexels& texels, const Vec2& place, float weight, const float* step, float* to) {
  VELOUR_SIMD_DISPATCH(add_bytes)(texels, place, weight, step, to);
}

}  // namespace velour
#endif
