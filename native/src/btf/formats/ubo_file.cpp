#include "btf/formats/ubo_file.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/transposed.h"
#include "btf/formats/image_set.h"

namespace velour {
namespace {

constexpr uint64_t kTexelsAtOnce = 1024;
/// Added by the database's own programs before taking logarithms.
constexpr float kEpsilon = 1e-5f;

/// Converts BT.601 luminance and color differences to RGB.
Rgb rgb_of_yuv(const Rgb& c) {
  return {c.r + 1.13983f * c.b, c.r - 0.39465f * c.g - 0.5806f * c.b, c.r + 2.03211f * c.g};
}

Rgb decoded(UboColors colors, const Rgb& c) {
  switch (colors) {
    case UboColors::rgb:
      return c;
    case UboColors::yuv:
      return rgb_of_yuv(c);
    case UboColors::log_y_uv:
      return rgb_of_yuv({std::exp(c.r) - kEpsilon, c.g, c.b});
    case UboColors::log_y_ratios: {
      const float y = std::exp(c.r);
      return rgb_of_yuv({y - kEpsilon, c.g * y, c.b * y});
    }
    default:
      return {std::exp(c.r) - kEpsilon, std::exp(c.g) - kEpsilon, std::exp(c.b) - kEpsilon};
  }
}

const char* name_of(UboColors colors) {
  switch (colors) {
    case UboColors::rgb:
      return "RGB";
    case UboColors::yuv:
      return "YUV";
    case UboColors::log_y_uv:
      return "ln Y, U, V";
    case UboColors::log_y_ratios:
      return "ln Y, U/Y, V/Y";
    default:
      return "ln RGB";
  }
}

template <typename T>
void copy_numbers(const std::vector<uint8_t>& bytes, std::vector<float>& floats) {
  for (size_t i = 0; i < floats.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    floats[i] = static_cast<float>(value);
  }
}

/// Factors of a range of texels: [component][texel] for each channel.
struct TexelBlock {
  uint64_t first = 0, count = 0;
  std::array<std::vector<float>, 3> factors;
};

class UboFile : public BtfMeasurement {
 public:
  UboFile(const std::string& path, const BtfLoadOptions& options) : file_(path), header_(read_ubo_header(file_)) {
    layout_ = header_.layout;
    grid_ = {header_.width, header_.height, options.tile_metres};
    const Vec2 tile = Vec2(header_.width, header_.height) / (1000.0f * header_.pixels_per_mm);
    if (!grid_.tile_metres && is_tile_size(tile)) grid_.tile_metres = tile;
    scale_ = options.values == BtfValues::automatic ? ValueScale{1, header_.cosine} : scale_of(options.values);
    provenance_ = {
        path,        std::filesystem::path(path).stem().string(), "ubo2014", header_.setup, sha256_of_file(path),
        file_.size()};
  }

  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    check_range(first, count);
    if (count == 0) return;
    const auto factors = pair_factors(first, count);
    const uint64_t rows_at_once = std::max<uint64_t>(1, kTexelsAtOnce / grid_.width);
    const uint64_t blocks = (grid_.height + rows_at_once - 1) / rows_at_once;
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t b) {
      const uint64_t row = b * rows_at_once, rows = std::min<uint64_t>(rows_at_once, grid_.height - row);
      const TexelBlock block = texel_block(row * grid_.width, rows * grid_.width);
      for (uint64_t i = 0; i < count; ++i) decode(first + i, i, factors, block, values);
    });
  }

  std::vector<std::pair<std::string, std::string>> details() const override {
    std::string components;
    for (const UboChannel& c : header_.channels) components += std::to_string(c.components) + " ";
    components.pop_back();
    return {{"values", scale_.text()},
            {"components", components},
            {"channels", name_of(header_.colors)},
            {"compression_error", "unknown: not stored in the file"},
            {"sensor", header_.sensor},
            {"light_source", header_.light_source}};
  }

 private:
  /// Reads `count` rows, [row][component].
  std::vector<float> rows_of(const UboChannel& channel, const UboMatrix& matrix, uint64_t first, uint64_t count) const {
    const uint64_t row_bytes = channel.components * channel.scalar_bytes;
    std::vector<uint8_t> bytes(count * row_bytes);
    file_.read(matrix.offset + first * row_bytes, bytes);
    std::vector<float> floats(count * channel.components);
    if (channel.scalar_bytes == 8) {
      copy_numbers<double>(bytes, floats);
    } else if (channel.scalar_bytes == 4) {
      copy_numbers<float>(bytes, floats);
    } else {
      std::vector<HalfBits> halves(floats.size());
      std::memcpy(halves.data(), bytes.data(), bytes.size());
      halves_to_floats(halves, floats);
    }
    return floats;
  }

  /// [pair][component] for each channel.
  std::array<std::vector<float>, 3> pair_factors(uint64_t first, uint64_t count) const {
    std::array<std::vector<float>, 3> factors;
    for (size_t c = 0; c < 3; ++c) {
      for (uint64_t i = 0; i < count; ++i) {
        const std::vector<float> row =
            rows_of(header_.channels[c], header_.channels[c].pairs, header_.row_of_pair[first + i], 1);
        factors[c].insert(factors[c].end(), row.begin(), row.end());
      }
    }
    return factors;
  }

  TexelBlock texel_block(uint64_t first, uint64_t count) const {
    TexelBlock block{first, count, {}};
    for (size_t c = 0; c < 3; ++c) {
      const UboChannel& channel = header_.channels[c];
      const std::vector<float> rows = rows_of(channel, channel.texels, first, count);
      block.factors[c] = transposed(rows, channel.components);
    }
    return block;
  }

  /// Decodes one channel of a pair. Products are always added in component order, so that a pair has the same bits in
  /// every range that contains it.
  static void multiply(const float* pair, const std::vector<float>& texels, std::span<float> sums) {
    std::ranges::fill(sums, 0.0f);
    for (size_t k = 0; k * sums.size() < texels.size(); ++k) {
      const float factor = pair[k];
      const float* row = texels.data() + k * sums.size();
      for (size_t t = 0; t < sums.size(); ++t) sums[t] += factor * row[t];
    }
  }

  void decode(uint64_t pair, uint64_t place, const std::array<std::vector<float>, 3>& pairs, const TexelBlock& block,
              std::span<HalfBits> values) const {
    std::array<std::vector<float>, 3> sums;
    for (size_t c = 0; c < 3; ++c) {
      sums[c].resize(block.count);
      multiply(pairs[c].data() + place * header_.channels[c].components, block.factors[c], sums[c]);
    }
    const float scale = scale_.of(layout().lights()[layout().light_of(pair)]);
    std::vector<float> rgb(3 * block.count);
    for (uint64_t t = 0; t < block.count; ++t) {
      const Rgb f = scale * decoded(header_.colors, {sums[0][t], sums[1][t], sums[2][t]});
      for (int c = 0; c < 3; ++c) rgb[3 * t + static_cast<size_t>(c)] = f[c];
    }
    store(place, block, rgb, values);
  }

  /// Flips rows: those of the file run from top to bottom.
  void store(uint64_t place, const TexelBlock& block, std::span<const float> rgb, std::span<HalfBits> values) const {
    const uint64_t row_values = uint64_t{3} * grid_.width;
    for (uint64_t done = 0; done < rgb.size(); done += row_values) {
      const uint64_t y = grid_.height - 1 - (3 * block.first + done) / row_values;
      floats_to_halves(rgb.subspan(done, row_values),
                       values.subspan((place * grid_.height + y) * row_values, row_values));
    }
  }

  RandomAccessFile file_;
  UboHeader header_;
  ValueScale scale_;
};

}  // namespace

std::shared_ptr<const BtfMeasurement> load_ubo_file(const std::string& path, const BtfLoadOptions& options) {
  return std::make_shared<UboFile>(path, options);
}

bool is_ubo_file(const std::string& path) {
  const std::vector<uint8_t> head = read_file_head(path, 5);
  const std::string text(head.begin(), head.end());
  return text == "!DFMF" || text.starts_with("!FMF") || text.starts_with("!PVF") || text == "!BDIF";
}

}  // namespace velour
