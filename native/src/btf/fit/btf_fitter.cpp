#include "btf/fit/btf_fitter.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace velour {

void BtfFitter::bound(uint64_t bytes, const char* one) {
  const std::vector<OrderPoint>& points = curve_.points;
  const auto past = std::upper_bound(points.begin(), points.end(), bytes,
                                     [](uint64_t n, const OrderPoint& p) { return n < p.parameter_bytes; });
  if (past == points.begin()) {
    throw Error(Status::invalid_argument,
                std::string(one) + " takes " + std::to_string(points.front().parameter_bytes) +
                    " bytes, but the maximum size is " + std::to_string(bytes) + " bytes. Raise the maximum size.");
  }
  largest_ = static_cast<size_t>(past - points.begin()) - 1;
}

}  // namespace velour
