#include "btf/component_ranges.h"

#include <algorithm>

namespace velour {

ComponentRanges::ComponentRanges(const FactoredBtf& btf) {
  const size_t groups = btf.by_view() ? btf.layout.views().size() : 1;
  uint32_t at = 0;
  const auto number = [](size_t k) { return static_cast<uint32_t>(k); };
  for (size_t group = 0; group < groups; ++group) {
    Bounds& bounds = bounds_.emplace_back();
    for (size_t a = 0; a < 3; ++a) {
      bounds[a] = at;
      while (at < number(btf.components()) && btf.axis[at] == a && (!btf.by_view() || btf.view[at] == group)) ++at;
    }
    bounds[3] = at;
  }
}

}  // namespace velour
