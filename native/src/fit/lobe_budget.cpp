#include "fit/lobe_budget.h"

#include <limits>

namespace velour {
namespace {

double cost(const ViewPath& view, size_t lobes) {
  const double e = view.path[lobes].relative_l2;
  return view.importance * e * e;
}

/// The best next saving of one view: the shorter prefix with the smallest rise of error per lobe (the convex hull of
/// the path, so that a flat stretch behind a steep one is found).
struct Saving {
  size_t to = 0;
  double rise_per_lobe = std::numeric_limits<double>::infinity();
};

Saving best_saving(const ViewPath& view, size_t from) {
  Saving best;
  for (size_t to = 0; to < from; ++to) {
    const double rise = (cost(view, to) - cost(view, from)) / static_cast<double>(from - to);
    if (rise < best.rise_per_lobe) best = {to, rise};
  }
  return best;
}

}  // namespace

std::vector<size_t> share_lobes(const std::vector<ViewPath>& views, uint64_t lobes) {
  std::vector<size_t> share;
  uint64_t used = 0;
  for (const ViewPath& v : views) {
    share.push_back(v.path.size() - 1);
    used += share.back();
  }
  while (used > lobes) {
    size_t cheapest = views.size();
    Saving best;
    for (size_t i = 0; i < views.size(); ++i) {
      const Saving saving = best_saving(views[i], share[i]);
      if (saving.rise_per_lobe < best.rise_per_lobe) best = saving, cheapest = i;
    }
    if (cheapest == views.size()) break;  // no lobes are left
    used -= share[cheapest] - best.to;
    share[cheapest] = best.to;
  }
  return share;
}

std::vector<size_t> thinned(size_t count, size_t keep) {
  std::vector<size_t> out;
  if (keep >= count) keep = count;
  for (size_t i = 0; i < keep; ++i) out.push_back(keep == 1 ? 0 : i * (count - 1) / (keep - 1));
  return out;
}

}  // namespace velour
