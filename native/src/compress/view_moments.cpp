#include "compress/view_moments.h"

#include <algorithm>

#include "compress/texel_pieces.h"
#include "job/parallel.h"

namespace velour {
namespace {

constexpr size_t kFunctions = 16;  // per piece of work; fixed, because sums depend on it

size_t pieces(size_t count, size_t of_piece) { return (count + of_piece - 1) / of_piece; }

}  // namespace

ViewMoments::ViewMoments(Index functions, Index lights) : products(RowMatrix::Zero(functions, functions)) {
  for (RowMatrix& image : images) image = RowMatrix::Zero(functions, lights);
}

void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments) {
  const Index functions = moments.products.rows();
  RowMatrix spread(static_cast<Index>(seen.texels()), functions);
  parallel_pieces(pieces(seen.texels(), kTexelsPerPiece), threads, progress, [&](size_t piece) {
    const size_t first = piece * kTexelsPerPiece, end = std::min(seen.texels(), first + kTexelsPerPiece);
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

void add_hidden(const ShownViews& shown, Index view, const LevelImages& images, const TensorTexelValues& values,
                float brightness, int threads, const Progress& progress, std::vector<ViewMoments>& moments) {
  if (shown.all()) return;
  const ShownViews::Values of_view = shown.values(view, images, progress);
  const auto members = static_cast<size_t>(values.members());
  const Index rank = values.rank();
  parallel_pieces(moments.size(), threads, progress, [&](size_t v) {
    const auto hiding = static_cast<Index>(v);
    for (size_t t = 0; t < shown.texels(); ++t) {
      if (hiding == view || shown.stand_in(t, hiding) != view) continue;
      const auto row = static_cast<Index>(t);
      for (size_t k = 0; k < members; ++k) {
        const auto own = ShownViews::kHidden * values.value.row(row).segment(static_cast<Index>(k) * rank, rank);
        const Index first = values.member[t * members + k] * rank;
        for (size_t j = 0; j < members; ++j) {
          moments[v].products.block(first, values.member[t * members + j] * rank, rank, rank).noalias() +=
              own.transpose() * values.value.row(row).segment(static_cast<Index>(j) * rank, rank);
        }
        for (size_t a = 0; a < 3; ++a) {
          moments[v].images[a].middleRows(first, rank).noalias() += brightness * own.transpose() * of_view[a].row(row);
        }
      }
    }
  });
}

}  // namespace velour
