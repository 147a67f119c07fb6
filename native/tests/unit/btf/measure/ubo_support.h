// A writer of .btf files by the layout of docs/reference/btf_formats.md: no file of Bonn's own is at hand.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "btf/measure/half_floats.h"
#include "btf/measure/pair_layout.h"
#include "math/sphere/random.h"

namespace velour::test {

struct UboExample {
  uint32_t version = 4, cosine = 0, width = 4, height = 3;
  float pixels_per_mm = 2;
  int32_t color_model = 0;
  bool texels_first = false;  // the left factor is the textures'
  uint8_t scalar_bytes = 2;
  std::array<uint32_t, 3> components{3, 2, 1};
  std::vector<PolarAngles> views{{0, 0}, {45, 90}};  // radians in the file
  std::vector<std::vector<PolarAngles>> lights{{{30, 0}, {60, 120}}, {{30, 0}, {60, 120}}};
  std::array<std::vector<float>, 3> pairs, texels;  // [row][component], numbers that a half float holds

  uint64_t pair_count() const {
    uint64_t count = 0;
    for (const auto& of_view : lights) count += of_view.size();
    return count;
  }

  void randomize(uint64_t seed) {
    RandomStream random(seed, 1, 0);
    const auto fill = [&](std::vector<float>& values, uint64_t count) {
      values.resize(count);
      for (float& v : values) v = std::round(random.next() * 64) / 64 - 0.25f;
    };
    for (size_t c = 0; c < 3; ++c) {
      fill(pairs[c], pair_count() * components[c]);
      fill(texels[c], uint64_t{width} * height * components[c]);
    }
  }

  /// What channel c of a row of the pairs and a texel, counted from the top left, is.
  double channel(size_t c, uint64_t row, uint64_t texel) const {
    double sum = 0;
    for (uint64_t k = 0; k < components[c]; ++k)
      sum += double{pairs[c][row * components[c] + k]} * double{texels[c][texel * components[c] + k]};
    return sum;
  }

  std::vector<uint8_t> bytes() const {
    std::vector<uint8_t> description;
    put(description, version);
    put_text(description, "test setup", 80);
    put_text(description, "test sensor", 80);
    put_text(description, "test lamp", 80);
    put(description, pixels_per_mm);
    for (int i = 0; i < 3; ++i) put(description, 1.0f);
    if (version > 1) put(description, cosine);
    if (version > 2) {
      put(description, uint32_t{5});
      put_text(description, "<x/>", 5);
    }
    if (version > 3) {
      put(description, uint32_t{3});
      for (const char* name : {"R", "G", "B"}) {
        put(description, uint32_t{1});
        put_text(description, name, 1);
      }
    }
    std::vector<uint8_t> file;
    put_text(file, "!DFMF08FCR", 10);
    put(file, static_cast<uint32_t>(description.size() + 4));
    file.insert(file.end(), description.begin(), description.end());
    put_sampling(file);
    put(file, width);
    put(file, height);
    put(file, uint32_t{1});  // a rotation
    for (int i = 0; i < 9; ++i) put(file, i % 4 == 0 ? 1.0f : 0.0f);
    put(file, components[0]);
    put(file, color_model);
    for (int i = 0; i < 12; ++i) put(file, 0.0f);
    for (size_t c = 0; c < 3; ++c) put_channel(file, c);
    return file;
  }

 private:
  template <typename T>
  static void put(std::vector<uint8_t>& file, T value) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    file.insert(file.end(), bytes, bytes + sizeof(T));
  }

  static void put_text(std::vector<uint8_t>& file, std::string text, size_t length) {
    text.resize(length);
    for (const char c : text) file.push_back(static_cast<uint8_t>(c));
  }

  static void put_direction(std::vector<uint8_t>& file, const PolarAngles& d) {
    put(file, static_cast<float>(d.theta * M_PI / 180));
    put(file, static_cast<float>(d.phi * M_PI / 180));
  }

  void put_sampling(std::vector<uint8_t>& file) const {
    put(file, static_cast<uint32_t>(views.size()));
    for (size_t v = 0; v < views.size(); ++v) {
      put_direction(file, views[v]);
      put(file, static_cast<uint32_t>(lights[v].size()));
      for (const PolarAngles& light : lights[v]) put_direction(file, light);
    }
  }

  void put_numbers(std::vector<uint8_t>& file, const std::vector<float>& values) const {
    for (const float v : values) {
      HalfBits half;
      floats_to_halves({&v, 1}, {&half, 1});
      if (scalar_bytes == 2) put(file, half);
      if (scalar_bytes == 4) put(file, v);
      if (scalar_bytes == 8) put(file, static_cast<double>(v));
    }
  }

  void put_channel(std::vector<uint8_t>& file, size_t c) const {
    const auto &left = texels_first ? texels[c] : pairs[c], &right = texels_first ? pairs[c] : texels[c];
    put(file, scalar_bytes);
    put(file, components[c]);
    put(file, static_cast<uint32_t>(left.size() / components[c]));
    put(file, static_cast<uint32_t>(right.size() / components[c]));
    put_numbers(file, std::vector<float>(components[c], 1.0f));  // singular values
    put_numbers(file, left);
    put_numbers(file, right);
  }
};

}  // namespace velour::test
