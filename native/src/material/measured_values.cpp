#include "material/measured_values.h"

namespace velour {

void measured_values(const Measurement& measurement, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f) {
  Vec3 directions[DirectionBatch::kCapacity];
  Rgb measured[DirectionBatch::kCapacity];
  uint8_t covered[DirectionBatch::kCapacity];
  const auto count = static_cast<size_t>(wl.count);
  for (int i = 0; i < wl.count; ++i) directions[i] = wl.get(i);
  measurement.eval(wv, {directions, count}, {measured, count}, {covered, count});
  for (int i = 0; i < wl.count; ++i) {
    f.set(i, covered[i] && wl.z[i] > 0 ? glm::max(measured[i], Rgb(0)) : Rgb(0));
  }
}

}  // namespace velour
