// How the sides of a BTF share its bytes.
#pragma once

#include "compress/lobe_order.h"
#include "model/order_curve.h"

namespace velour {

/// What a side asks for.
struct SideDemand {
  LobeOrder order;
  double energy = 0;  // sum of squares of all its companded values: what its share of errors is of
};

/// Every side has one coefficient; each further one goes where it leaves the least error of the whole.
class SideShares {
 public:
  /// `texels`: of all levels of a side.
  SideShares(const std::vector<SideDemand>& sides, uint64_t texels);

  /// By coefficients: relative L2 error that the orders leave, bytes, coefficients of the side that has most.
  const OrderCurve& curve() const { return curve_; }
  /// Coefficients of each side at a point of the curve.
  std::vector<size_t> at(size_t point) const;

 private:
  void add_point(const std::vector<SideDemand>& sides, const std::vector<size_t>& count, uint64_t texels);

  size_t sides_;
  std::vector<size_t> next_;  // the side that gets each coefficient after the first of every side
  OrderCurve curve_;
};

/// Of a side of SRBFs, as they are stored: a byte a coefficient and a height a texel, scales and lobes.
uint64_t srbf_side_bytes(uint64_t texels, size_t coefficients, size_t lobes);

}  // namespace velour
