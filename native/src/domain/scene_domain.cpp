#include "domain/scene_domain.h"

#include <algorithm>
#include <numeric>

namespace velour {

double SceneDomain::weight() const { return std::accumulate(view.begin(), view.end(), 0.0); }

ViewWeights SceneDomain::directions() const { return surface.views.sum() > 0 ? surface.views : all_around(view); }

ViewRange view_range(const SceneDomain& domain) {
  const double outside = kOutside * domain.weight();
  int begin = 0, end = SceneDomain::kViewBins;
  for (double left = 0; begin < end && (left += domain.view[static_cast<size_t>(begin)]) <= outside;) ++begin;
  for (double left = 0; end > begin && (left += domain.view[static_cast<size_t>(end - 1)]) <= outside;) --end;
  if (begin == end) return {};
  return {std::max(0, begin - 1), std::min(SceneDomain::kViewBins, end + 1)};
}

}  // namespace velour
