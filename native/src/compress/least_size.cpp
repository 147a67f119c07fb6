#include "compress/least_size.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace velour {
namespace {

/// Between `size`, which is too small, and its double: the first good one of four steps per octave.
size_t least_between(size_t size, size_t end, const std::function<bool(size_t)>& good) {
  std::array<size_t, 4> sizes{};
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double part = std::exp2(static_cast<double>(i + 1) / static_cast<double>(sizes.size()));
    sizes[i] = static_cast<size_t>(static_cast<double>(size + 1) * part + 0.5) - 1;
  }
  const auto distinct = std::unique(sizes.begin(), sizes.end());
  return *std::partition_point(sizes.begin(), distinct - 1, [&](size_t s) { return s < end && !good(s); });
}

}  // namespace

size_t least_size(size_t end, const std::function<bool(size_t)>& good) {
  if (end == 0 || good(0)) return 0;
  size_t bad = 0;
  for (size_t size = 1; size < end && !good(size); size = 2 * size + 1) bad = size;
  return std::min(end, least_between(bad, end, good));
}

}  // namespace velour
