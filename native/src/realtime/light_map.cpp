#include "realtime/light_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "math/sphere/warp.h"
#include "math/srbf/kernel.h"
#include "math/srbf/lobe_products.h"

namespace velour {
namespace {

constexpr int kCosineSide = 48, kEnvironmentSide = 1024, kMinSide = 24, kMaxSide = 640;
constexpr double kPixelsOfDeviation = 3.5;  // per lobe's; linear look-ups then err by 1/98 of its peak along each axis
constexpr int kTableAngles = 256;           // entries of the table of ReceivedLight

struct Map {
  int x, y, side;  // of the border's first pixel; side without borders
};

int side_of(int level) {
  if (level == LightLevels::kCosine) return kCosineSide;
  if (level == LightLevels::kSky) return kEnvironmentSide;
  const double deviations = std::sqrt(4 * kPiD * LightLevels::bandwidth(level));
  return std::clamp(static_cast<int>(kPixelsOfDeviation * deviations), kMinSide, kMaxSide);
}

/// Places the maps on shelves below the row of entries, largest first.
std::array<Map, LightLevels::kCount> placed_maps(uint32_t& width, uint32_t& height) {
  std::array<Map, LightLevels::kCount> maps{};
  int x = 0, y = 1, shelf = 0;
  constexpr int kWidth = 1728;
  for (int level = LightLevels::kCount - 1; level >= 0; --level) {
    const int side = side_of(level), outer = side + 2;
    if (x + outer > kWidth) x = 0, y += shelf, shelf = 0;
    maps[static_cast<size_t>(level)] = {x, y, side};
    x += outer;
    shelf = std::max(shelf, outer);
  }
  width = kWidth;
  height = static_cast<uint32_t>(y + shelf);
  return maps;
}

/// Direction of a pixel of a map, border included: the octahedral map continues over its edges, rotated by a half turn.
Vec3 direction_at(int x, int y, int side) {
  const auto to_square = [&](int i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(side); };
  Vec2 square(to_square(x), to_square(y));
  if (x < 0 || x >= side) square = {x < 0 ? -square.x : 2 - square.x, 1 - square.y};
  if (y < 0 || y >= side) square = {1 - square.x, y < 0 ? -square.y : 2 - square.y};
  return octahedral_to(square);
}

/// Irradiance / pi from a Gaussian of amplitude 1, by the angle between the receiver's normal and the lobe's center.
class ReceivedLight {
 public:
  explicit ReceivedLight(double bandwidth) {
    constexpr int kZeniths = 64;
    const double least = std::max(bandwidth, 1e-4), whole = kernel_integral(Kernel::gaussian, least);
    for (int a = 0; a < kTableAngles; ++a) {
      const double angle = kPiD * a / (kTableAngles - 1);
      double sum = 0;
      for (int i = 0; i < kZeniths; ++i) {
        const double d = kernel_sample(Kernel::gaussian, least, (i + 0.5) / kZeniths);
        sum += mean_clipped(std::cos(angle) * (1 - d), std::sin(angle) * std::sqrt(d * (2 - d)));
      }
      by_angle_[static_cast<size_t>(a)] = static_cast<float>(whole * sum / kZeniths / kPiD);
    }
  }

  float at(float cosine) const {
    const float place = std::acos(std::clamp(cosine, -1.0f, 1.0f)) / kPi * (kTableAngles - 1);
    const auto first = std::min(static_cast<size_t>(place), size_t{kTableAngles - 2});
    const float t = place - static_cast<float>(first);
    return (1 - t) * by_angle_[first] + t * by_angle_[first + 1];
  }

 private:
  /// Mean of max(a + b cos phi, 0) over phi; b >= 0.
  static double mean_clipped(double a, double b) {
    if (a >= b) return a;
    if (a <= -b) return 0;
    const double edge = std::acos(-a / b);
    return (a * edge + b * std::sin(edge)) / kPiD;
  }
  std::array<float, kTableAngles> by_angle_;
};

constexpr float kMinLobeShare = 1e-5f;  // of the mean radiance: environment lobes that add less are omitted

/// Part of a mixture in the form of multiply_lobes(): amplitudes 1, in blocks of as many lobes as lanes.
class Lobes {
 public:
  /// Takes the lobes that add at least a luminance of `least` to the mean over Gaussians of this bandwidth, anywhere
  /// within `reach` radians of `center`.
  Lobes(const EnvironmentMixture& sky, float least, float bandwidth, const Vec3& center, float reach)
      : bandwidth_(bandwidth),
        amplitude_(1 / static_cast<float>(kernel_integral(Kernel::gaussian, static_cast<double>(bandwidth)))) {
    GaussianLobes near;
    for (size_t k = 0; k < sky.size(); ++k) {
      const float angle = std::acos(std::clamp(glm::dot(center, sky.center[k]), -1.0f, 1.0f)) - reach;
      const float both = bandwidth * sky.bandwidth[k] / (bandwidth + sky.bandwidth[k]);
      const float least_exponent = angle > 0 ? both * (1 - std::cos(angle)) : 0;
      if (luminance(sky.coefficient[k]) * std::exp(-least_exponent) < least) continue;
      near.add({sky.center[k], sky.bandwidth[k], 1.0f});
      coefficient_.push_back(sky.coefficient[k]);
    }
    lobes_ = in_blocks(near);
  }

  /// Mean of the lobes over a Gaussian density around `center`.
  Rgb mean(const Vec3& center, LobeProducts& products) const {
    products.count = 0;
    multiply_lobes({center, bandwidth_, amplitude_}, lobes_, nullptr, products);
    Rgb sum(0.0f);
    for (size_t k = 0; k < coefficient_.size(); ++k) sum += products.mass[k] * coefficient_[k];
    return sum;
  }

 private:
  float bandwidth_, amplitude_;
  std::vector<LobeBlock> lobes_;
  std::vector<Rgb> coefficient_;
};

float mean_luminance(const EnvironmentMixture& sky) {
  double sum = 0;
  for (size_t k = 0; k < sky.size(); ++k) {
    sum += static_cast<double>(luminance(sky.coefficient[k])) *
           kernel_integral(Kernel::gaussian, static_cast<double>(sky.bandwidth[k]));
  }
  return static_cast<float>(sum / (4 * kPiD));
}

/// Pixels of a level that are computed together; (x, y) start at -1, border included.
struct Block {
  static constexpr int kSide = 16;
  int level, x, y, x_end, y_end;
};

std::vector<Block> blocks_of(const std::array<Map, LightLevels::kCount>& maps) {
  std::vector<Block> blocks;
  for (int level = 0; level < LightLevels::kCount; ++level) {
    const int end = maps[static_cast<size_t>(level)].side + 1;
    for (int y = -1; y < end; y += Block::kSide) {
      for (int x = -1; x < end; x += Block::kSide) {
        blocks.push_back({level, x, y, std::min(x + Block::kSide, end), std::min(y + Block::kSide, end)});
      }
    }
  }
  return blocks;
}

/// Fills the pixels of a block with `value(direction)`.
template <typename Value>
void fill(const Block& block, const Map& map, TablePixels& pixels, const Value& value) {
  for (int y = block.y; y < block.y_end; ++y) {
    for (int x = block.x; x < block.x_end; ++x) {
      const Rgb mean = value(direction_at(x, y, map.side));
      float* const to = pixels.at(static_cast<uint32_t>(map.x + 1 + x), static_cast<uint32_t>(map.y + 1 + y));
      for (int c = 0; c < 3; ++c) to[c] = mean[c];
      to[3] = 1;
    }
  }
}

/// The lobes that matter in a block. Looks at all its pixels, because those of the border lie elsewhere on the sphere
/// than its middle.
Lobes lobes_in(const Block& block, const Map& map, const EnvironmentMixture& sky, float least) {
  const Vec3 center = direction_at((block.x + block.x_end - 1) / 2, (block.y + block.y_end - 1) / 2, map.side);
  float reach = 0;
  for (int y = block.y; y < block.y_end; ++y) {
    for (int x = block.x; x < block.x_end; ++x) {
      reach = std::max(reach, glm::length(direction_at(x, y, map.side) - center));
    }
  }
  // Converts the chord to an angle, rounded up.
  return {sky, least, LightLevels::bandwidth(block.level), center, 2 * std::asin(std::min(reach / 2, 1.0f)) + 1e-3f};
}

}  // namespace

float LightLevels::of(float bandwidth) {
  const float known = std::clamp(bandwidth, 1.0f, LightLevels::bandwidth(kSharpest));
  return kBroadest + kPerOctave * std::log2(known);
}

float LightLevels::bandwidth(int level) { return std::exp2(static_cast<float>(level - kBroadest) / kPerOctave); }

TablePixels light_map(const EnvironmentMixture& sky, const Environment& environment, int threads, Progress& progress) {
  uint32_t width, height;
  const auto maps = placed_maps(width, height);
  TablePixels pixels(width, height);
  for (int level = 0; level < LightLevels::kCount; ++level) {
    const Map& map = maps[static_cast<size_t>(level)];
    float* const entry = pixels.at(static_cast<uint32_t>(level), 0);
    entry[0] = static_cast<float>(map.x + 1);
    entry[1] = static_cast<float>(map.y + 1);
    entry[2] = static_cast<float>(map.side);
  }
  const std::vector<ReceivedLight> received(sky.bandwidth.begin(), sky.bandwidth.end());
  const auto blocks = blocks_of(maps);
  const float least = kMinLobeShare * mean_luminance(sky);
  parallel_for_each(blocks.size(), threads, progress, [&](size_t i) {
    const Block& block = blocks[i];
    const Map& map = maps[static_cast<size_t>(block.level)];
    if (block.level == LightLevels::kSky) {
      fill(block, map, pixels, [&](const Vec3& w) { return environment.radiance(w); });
    } else if (block.level == LightLevels::kCosine) {
      fill(block, map, pixels, [&](const Vec3& w) {
        Rgb sum(0.0f);
        for (size_t k = 0; k < sky.size(); ++k) sum += received[k].at(glm::dot(w, sky.center[k])) * sky.coefficient[k];
        return sum;
      });
    } else {
      const Lobes lobes = lobes_in(block, map, sky, least);
      LobeProducts products;
      fill(block, map, pixels, [&](const Vec3& w) { return lobes.mean(w, products); });
    }
  });
  return pixels;
}

}  // namespace velour
