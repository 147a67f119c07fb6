#include "render/id_slots.h"

#include <algorithm>
#include <cstddef>

#include "render/pass_options.h"

namespace velour {

void add_id(float id, float weight, std::span<float> slots) {
  if (id == 0.0f || !(weight > 0.0f)) return;
  for (size_t i = 0; i + 1 < slots.size(); i += 2) {
    if (slots[i] != 0.0f && slots[i] != id) continue;
    slots[i] = id;
    slots[i + 1] += weight;
    return;
  }
}

void write_ids(std::span<const float> slots, int first, float scale, float out[4]) {
  struct Rank {
    float id, weight;
  };
  Rank ranks[floats_of_ids(PassOptions::kMostRanks) / 2] = {};
  size_t count = 0;
  for (size_t i = 0; i + 1 < slots.size() && slots[i] != 0.0f; i += 2) ranks[count++] = {slots[i], slots[i + 1]};
  std::sort(ranks, ranks + count,
            [](const Rank& a, const Rank& b) { return a.weight != b.weight ? a.weight > b.weight : a.id < b.id; });
  for (int k = 0; k < 2; ++k) {
    out[2 * k] = ranks[first + k].id;
    out[2 * k + 1] = ranks[first + k].weight * scale;
  }
}

}  // namespace velour
