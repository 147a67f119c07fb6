// Matrix products in blocks that fit the caches and tiles that fit the registers [GG08]. Highway compiles this file
// once per instruction set.
#include "math/tensor/matrix_product.h"

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/tensor/matrix_product.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;

constexpr Index kTileRows = 6;           // of two vectors each; with the factors they fill 16 registers
constexpr Index kDepth = 256;            // factors per entry that are packed together
constexpr Index kRows = 16 * kTileRows;  // of the left matrix that are packed together, for the L2 cache

/// Copies `width` numbers: kTileRows or a multiple of the vector size. A call of memmove would cost more than the copy.
HWY_INLINE void copy_few(const float* from, Index width, float* to) {
  const Lanes d;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  if (width == kTileRows) {
    for (Index i = 0; i < kTileRows; ++i) to[i] = from[i];
  } else {
    for (Index i = 0; i < width; i += lanes) hn::StoreU(hn::LoadU(d, from + i), d, to + i);
  }
}

/// Packs panels of `width` rows each, column by column, with zeros beyond the last row. Pass the transpose to pack
/// panels of columns.
void pack(const StridedMatrix<const float>& m, Index width, std::vector<float>& to) {
  const Index panels = (m.rows + width - 1) / width;
  to.resize(static_cast<size_t>(panels * width * m.columns));
  float* target = to.data();
  for (Index first = 0; first < m.rows; first += width) {
    const Index count = std::min(width, m.rows - first);
    const float* from = m.data + first * m.row_stride;
    for (Index k = 0; k < m.columns; ++k, from += m.column_stride, target += width) {
      if (count < width) std::fill_n(target, width, 0.0f);
      if (m.row_stride == 1 && count == width) {
        copy_few(from, width, target);
      } else {
        for (Index i = 0; i < count; ++i) target[i] = from[i * m.row_stride];
      }
    }
  }
}

/// Computes the product of two panels: [kTileRows][two vectors].
template <class D>
HWY_INLINE void multiply_tile(D d, const float* rows, const float* columns, Index depth, float* tile) {
  const size_t lanes = hn::Lanes(d);
  auto a0 = hn::Zero(d), a1 = a0, b0 = a0, b1 = a0, c0 = a0, c1 = a0, d0 = a0, d1 = a0, e0 = a0, e1 = a0, f0 = a0,
       f1 = a0;
  for (Index k = 0; k < depth; ++k, rows += kTileRows, columns += 2 * lanes) {
    const auto x = hn::LoadU(d, columns), y = hn::LoadU(d, columns + lanes);
    const auto add = [&](Index row, auto& first, auto& second) HWY_ATTR {
      const auto factor = hn::Set(d, rows[row]);
      first = hn::MulAdd(factor, x, first);
      second = hn::MulAdd(factor, y, second);
    };
    add(0, a0, a1);
    add(1, b0, b1);
    add(2, c0, c1);
    add(3, d0, d1);
    add(4, e0, e1);
    add(5, f0, f1);
  }
  const auto keep = [&](size_t row, auto first, auto second) HWY_ATTR {
    hn::StoreU(first, d, tile + 2 * row * lanes);
    hn::StoreU(second, d, tile + (2 * row + 1) * lanes);
  };
  keep(0, a0, a1);
  keep(1, b0, b1);
  keep(2, c0, c1);
  keep(3, d0, d1);
  keep(4, e0, e1);
  keep(5, f0, f1);
}

/// Writes a tile to the product; `adds`: adds to the values there.
HWY_INLINE void put_tile(const float* tile, Index width, bool adds, const StridedMatrix<float>& to) {
  const Lanes d;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  const bool whole = to.column_stride == 1 && to.columns == width;
  for (Index i = 0; i < to.rows; ++i, tile += width) {
    float* const row = to.data + i * to.row_stride;
    for (Index j = 0; whole && j < width; j += lanes) {
      const auto values = hn::LoadU(d, tile + j);
      hn::StoreU(adds ? hn::Add(values, hn::LoadU(d, row + j)) : values, d, row + j);
    }
    for (Index j = 0; !whole && j < to.columns; ++j) {
      float& entry = row[j * to.column_stride];
      entry = adds ? entry + tile[j] : tile[j];
    }
  }
}

/// `lower`: computes only tiles on or below the diagonal.
void multiply_simd(const StridedMatrix<const float>& a, const StridedMatrix<const float>& b,
                   const StridedMatrix<float>& product, bool lower) {
  static thread_local std::vector<float> packed_rows, packed_columns;
  const Lanes d;
  const Index width = 2 * static_cast<Index>(hn::Lanes(d));
  alignas(64) float tile[kTileRows * 2 * 16];
  for (Index from = 0; from < std::max<Index>(a.columns, 1); from += kDepth) {
    const Index depth = std::min(kDepth, a.columns - from);
    pack({b.data + from * b.row_stride, b.columns, depth, b.column_stride, b.row_stride}, width, packed_columns);
    for (Index top = 0; top < a.rows; top += kRows) {
      const Index rows = std::min(kRows, a.rows - top);
      pack({a.data + top * a.row_stride + from * a.column_stride, rows, depth, a.row_stride, a.column_stride},
           kTileRows, packed_rows);
      for (Index j = 0; j < b.columns; j += width) {
        for (Index i = 0; i < rows; i += kTileRows) {
          if (lower && j > top + i + kTileRows - 1) continue;
          multiply_tile(d, packed_rows.data() + i * depth, packed_columns.data() + j * depth, depth, tile);
          put_tile(
              tile, width, from > 0,
              {product.data + (top + i) * product.row_stride + j * product.column_stride, std::min(kTileRows, rows - i),
               std::min(width, b.columns - j), product.row_stride, product.column_stride});
        }
      }
    }
  }
}

/// `kVectors` vectors of entries, from the one at `top`.
template <size_t kVectors>
HWY_INLINE void multiply_rows(const StridedMatrix<const float>& a, Index top, const float* x, float* product) {
  const Lanes d;
  const size_t lanes = hn::Lanes(d);
  auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
  const float* column = a.data + top;
  for (Index j = 0; j < a.columns; ++j, column += a.column_stride) {
    const auto factor = hn::Set(d, x[j]);
    s0 = hn::MulAdd(factor, hn::LoadU(d, column), s0);
    if constexpr (kVectors == 4) {
      s1 = hn::MulAdd(factor, hn::LoadU(d, column + lanes), s1);
      s2 = hn::MulAdd(factor, hn::LoadU(d, column + 2 * lanes), s2);
      s3 = hn::MulAdd(factor, hn::LoadU(d, column + 3 * lanes), s3);
    }
  }
  float* const to = product + top;
  hn::StoreU(s0, d, to);
  if constexpr (kVectors == 4) {
    hn::StoreU(s1, d, to + lanes);
    hn::StoreU(s2, d, to + 2 * lanes);
    hn::StoreU(s3, d, to + 3 * lanes);
  }
}

void multiply_vector_simd(const StridedMatrix<const float>& a, const float* x, float* product) {
  const auto lanes = static_cast<Index>(hn::Lanes(Lanes()));
  Index top = 0;
  for (; top + 4 * lanes <= a.rows; top += 4 * lanes) multiply_rows<4>(a, top, x, product);
  for (; top + lanes <= a.rows; top += lanes) multiply_rows<1>(a, top, x, product);
  if (top == a.rows) return;
  // The remaining rows are the end of a vector that begins before them, if the matrix has that many rows.
  if (a.rows >= lanes) return multiply_rows<1>(a, a.rows - lanes, x, product);
  for (; top < a.rows; ++top) {
    product[top] = 0;
    for (Index j = 0; j < a.columns; ++j) product[top] += a.data[top + j * a.column_stride] * x[j];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(multiply_simd);
HWY_EXPORT(multiply_vector_simd);

void multiply(const StridedMatrix<const float>& a, const StridedMatrix<const float>& b,
              const StridedMatrix<float>& product) {
  VELOUR_SIMD_DISPATCH(multiply_simd)(a, b, product, false);
}

void multiply(const StridedMatrix<const float>& a, const float* x, float* product) {
  VELOUR_SIMD_DISPATCH(multiply_vector_simd)(a, x, product);
}

void multiply_by_itself(const StridedMatrix<const float>& a, const StridedMatrix<float>& product) {
  VELOUR_SIMD_DISPATCH(multiply_simd)(a, {a.data, a.columns, a.rows, a.column_stride, a.row_stride}, product, true);
}

}  // namespace velour
#endif
