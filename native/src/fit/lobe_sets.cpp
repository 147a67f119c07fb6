#include "fit/lobe_sets.h"

namespace velour {
namespace {

using Index = Eigen::Index;

/// Number of rows of the control values [node][parameter][lobe], each of all lobes.
Index rows_of(const ParametricBrdf& model) {
  return static_cast<Index>(model.spline().node_count()) * model.parameter_count();
}

}  // namespace

TrackedLobes without_lobe(const TrackedLobes& lobes, Index lobe) {
  TrackedLobes out = lobes;
  out.model.space.erase(out.model.space.begin() + lobe);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows * (count - 1));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (count - 1), lobe) = lobes.x.segment(r * count, lobe);
    out.x.segment(r * (count - 1) + lobe, count - 1 - lobe) = lobes.x.segment(r * count + lobe + 1, count - 1 - lobe);
  }
  return out;
}

TrackedLobes only_lobe(const TrackedLobes& lobes, Index lobe) {
  TrackedLobes out = lobes;
  out.model.space.assign(1, lobes.model.space[static_cast<size_t>(lobe)]);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows);
  for (Index r = 0; r < rows; ++r) out.x[r] = lobes.x[r * count + lobe];
  return out;
}

TrackedLobes joined(const TrackedLobes& lobes, const TrackedLobes& more) {
  TrackedLobes out = lobes;
  out.model.space.insert(out.model.space.end(), more.model.space.begin(), more.model.space.end());
  const Index rows = rows_of(lobes.model), first = lobes.model.lobe_count(), second = more.model.lobe_count();
  out.x.resize(rows * (first + second));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (first + second), first) = lobes.x.segment(r * first, first);
    out.x.segment(r * (first + second) + first, second) = more.x.segment(r * second, second);
  }
  return out;
}

}  // namespace velour
