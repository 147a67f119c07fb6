#include "material/btf_look_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "job/parallel.h"

namespace velour {
namespace {

// Measured on woven cloth and on chain mail of 64 texels: half the cells raise the variance by 7 %, three views per
// side by 4 %; six gain nothing.
constexpr uint32_t kMostCells = 64;  // along both axes
constexpr uint32_t kViewCells = 4;   // along both axes of the disk
constexpr float kRim = 0.95f;        // maximum radius of a view on the disk

/// Views are cells of the unit disk under the equal-area map.
size_t nearest_view(const Vec3& wv) {
  const float sine = std::sqrt(wv.x * wv.x + wv.y * wv.y), radius = std::sqrt(std::max(0.0f, 1 - wv.z));
  const float scale = sine > 0 ? radius / sine : 0.0f;
  const auto cell = [&](float x) {
    return std::min(static_cast<uint32_t>(std::max(0.0f, 0.5f * kViewCells * (1 + scale * x))), kViewCells - 1);
  };
  return size_t{cell(wv.y)} * kViewCells + cell(wv.x);
}

Vec3 view_in(size_t view) {
  const auto middle = [](size_t i) { return (2 * static_cast<float>(i) + 1) / kViewCells - 1; };
  const Vec2 at(middle(view % kViewCells), middle(view / kViewCells));
  const float radius = std::min(glm::length(at), kRim), cosine = 1 - radius * radius;
  const Vec2 across = at * (std::sqrt(1 - cosine * cosine) / std::max(glm::length(at), 1e-6f));
  return {across.x, across.y, cosine};
}

uint32_t cell_of(float period, uint32_t cells) {
  const float inside = std::isfinite(period) ? period - std::floor(period) : 0.0f;
  return std::min(static_cast<uint32_t>(inside * static_cast<float>(cells)), cells - 1);
}

// Strengths as logarithmic bytes, from 1e-5 to 3000; 0 stands for 0.
constexpr float kStepsPerOctave = 9, kOne = 150;

uint8_t byte_of(float strength) {
  const float steps = std::log2(strength) * kStepsPerOctave + kOne;
  return steps >= 0.5f ? static_cast<uint8_t>(std::lround(std::min(steps, 255.0f))) : uint8_t{0};
}

struct StrengthOfByte {
  StrengthOfByte() {
    for (size_t i = 1; i < strength.size(); ++i) {
      strength[i] = std::exp2((static_cast<float>(i) - kOne) / kStepsPerOctave);
    }
  }
  std::array<float, 256> strength{};
};
const StrengthOfByte kOfByte;

}  // namespace

BtfLookTable::BtfLookTable(const Vec2& texels, const Ask& ask) {
  const float most = std::max(texels.x, texels.y);
  cells_ = std::min(std::bit_ceil(static_cast<uint32_t>(most)), kMostCells);
  finest_ = std::max(0.0f, std::log2(most / static_cast<float>(cells_)));
  const auto levels = static_cast<uint32_t>(std::bit_width(cells_));
  strengths_.resize(first_of(levels));
  const auto fill = [&](uint32_t level, uint32_t cells, size_t cell) {
    const Vec2 uv = (Vec2(cell % cells, cell / cells) + 0.5f) / static_cast<float>(cells);
    for (size_t view = 0; view < kViewCells * kViewCells; ++view) {
      const Broad broad = ask(uv, finest_ + static_cast<float>(level), view_in(view));
      std::ranges::transform(broad, strengths_[first_of(level) + cell * kViewCells * kViewCells + view].begin(),
                             byte_of);
    }
  };
  for (uint32_t level = 0; level < levels; ++level) {
    const uint32_t cells = cells_ >> level;
    parallel_fill(size_t{cells} * cells, [&](size_t cell) { fill(level, cells, cell); });
  }
}

size_t BtfLookTable::first_of(uint32_t level) const {
  size_t cells = 0;
  for (uint32_t l = 0; l < level; ++l) cells += size_t{cells_ >> l} * (cells_ >> l);
  return cells * kViewCells * kViewCells;
}

BtfLookTable::Broad BtfLookTable::look_up(const Vec2& uv, float level, const Vec3& wv) const {
  const auto last = static_cast<float>(std::bit_width(cells_) - 1);
  const auto at = static_cast<uint32_t>(std::clamp(std::round(level - finest_), 0.0f, last));
  const uint32_t cells = cells_ >> at;
  const size_t cell = size_t{cell_of(uv.y, cells)} * cells + cell_of(uv.x, cells);
  Broad broad;
  std::ranges::transform(strengths_[first_of(at) + cell * kViewCells * kViewCells + nearest_view(wv)], broad.begin(),
                         [](uint8_t byte) { return kOfByte.strength[byte]; });
  return broad;
}

}  // namespace velour
