#include "compress/side_shares.h"

#include <algorithm>
#include <cmath>

#include "btf/srbf_btf.h"

namespace velour {
namespace {

/// Residual sum of squares of a side after `count` coefficients.
double left(const SideDemand& side, size_t count) { return side.energy * side.order.left[count - 1]; }

}  // namespace

uint64_t srbf_side_bytes(uint64_t texels, size_t coefficients, size_t lobes) {
  return texels * (coefficients + sizeof(HalfBits)) + lobes * sizeof(MultivariateLobe) +
         coefficients * (sizeof(uint16_t) + sizeof(ByteScale));
}

SideShares::SideShares(const std::vector<SideDemand>& sides, uint64_t texels) : sides_(sides.size()) {
  std::vector<size_t> count(sides.size(), 1);
  add_point(sides, count, texels);
  for (;;) {
    size_t to = sides.size();
    double most = -1;
    for (size_t s = 0; s < sides.size(); ++s) {
      if (count[s] >= sides[s].order.left.size()) continue;
      const double gain = left(sides[s], count[s]) - left(sides[s], count[s] + 1);
      if (gain > most) {
        most = gain;
        to = s;
      }
    }
    if (to == sides.size()) return;
    ++count[to];
    next_.push_back(to);
    add_point(sides, count, texels);
  }
}

void SideShares::add_point(const std::vector<SideDemand>& sides, const std::vector<size_t>& count, uint64_t texels) {
  double all = 0, rest = 0;
  OrderPoint point;
  for (size_t s = 0; s < sides.size(); ++s) {
    all += sides[s].energy;
    rest += left(sides[s], count[s]);
    point.lobes = std::max(point.lobes, static_cast<int>(count[s]));
    point.parameter_bytes += srbf_side_bytes(texels, count[s], sides[s].order.share(count[s])[0]);
  }
  point.relative_l2 = all > 0 ? std::sqrt(rest / all) : 0.0;
  curve_.points.push_back(point);
}

std::vector<size_t> SideShares::at(size_t point) const {
  std::vector<size_t> count(sides_, 1);
  for (size_t i = 0; i < point; ++i) ++count[next_[i]];
  return count;
}

}  // namespace velour
