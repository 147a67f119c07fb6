#include "btf/btf_measurement.h"

#include "job/error.h"

namespace velour {

void BtfMeasurement::check_range(uint64_t first, uint64_t count) const {
  if (first <= layout().pairs() && count <= layout().pairs() - first) return;
  throw Error(Status::invalid_argument, provenance_.path + ": has " + std::to_string(layout().pairs()) +
                                            " pairs of directions; " + std::to_string(count) + " from number " +
                                            std::to_string(first) + " on are not among them.");
}

}  // namespace velour
