#include "compress/view_moments.h"

#include <algorithm>

#include "job/parallel.h"

namespace velour {
namespace {

constexpr size_t kTexels = 64;     // of a piece of work
constexpr size_t kFunctions = 16;  // of a piece of work: fixed, as sums depend on it

size_t pieces(size_t count, size_t of_piece) { return (count + of_piece - 1) / of_piece; }

}  // namespace

ViewMoments::ViewMoments(Index functions, Index lights) : products(RowMatrix::Zero(functions, functions)) {
  for (RowMatrix& image : images) image = RowMatrix::Zero(functions, lights);
}

void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments) {
  const Index functions = moments.products.rows();
  RowMatrix spread(static_cast<Index>(seen.texels()), functions);
  parallel_pieces(pieces(seen.texels(), kTexels), threads, progress, [&](size_t piece) {
    const size_t first = piece * kTexels, end = std::min(seen.texels(), first + kTexels);
    spread.middleRows(static_cast<Index>(first), static_cast<Index>(end - first)) =
        seen.spread(view, first, end, values, functions);
  });
  parallel_pieces(pieces(static_cast<size_t>(functions), kFunctions), threads, progress, [&](size_t piece) {
    const auto first = static_cast<Index>(piece * kFunctions), count = std::min<Index>(kFunctions, functions - first);
    const auto some = spread.middleCols(first, count).transpose();
    moments.products.middleRows(first, count).noalias() += some * spread;
    for (size_t a = 0; a < 3; ++a) {
      moments.images[a].middleRows(first, count).noalias() += brightness * (some * images.value[a]);
    }
  });
}

}  // namespace velour
