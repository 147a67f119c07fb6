// Distribution of a BTF's bytes over its sides.
#pragma once

#include "compress/lobe_order.h"
#include "model/order_curve.h"

namespace velour {

/// Demand of one side.
struct SideDemand {
  LobeOrder order;
  double energy = 0;  // sum of squares of all its companded values, the reference of LobeOrder::left
};

/// Every side gets one coefficient; each further one goes to the side where it reduces the total error most.
class SideShares {
 public:
  /// `texels`: in all levels of a side.
  SideShares(const std::vector<SideDemand>& sides, uint64_t texels);

  /// By coefficients: relative L2 error that the orders leave, bytes, and coefficients of the largest side.
  const OrderCurve& curve() const { return curve_; }
  /// Coefficients of each side at a point of the curve.
  std::vector<size_t> at(size_t point) const;

 private:
  void add_point(const std::vector<SideDemand>& sides, const std::vector<size_t>& count, uint64_t texels);

  size_t sides_;
  std::vector<size_t> next_;  // the side that gets each coefficient after the first of every side
  OrderCurve curve_;
};

/// Stored size of a side of SRBFs: a byte per coefficient and a height for every texel, scales and lobes.
uint64_t srbf_side_bytes(uint64_t texels, size_t coefficients, size_t lobes);

}  // namespace velour
