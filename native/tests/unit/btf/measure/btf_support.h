// BTFs for tests.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "btf/formats/btf_folder.h"
#include "math/sphere/random.h"

namespace velour::test {

/// What `call` refuses with; empty when it does not.
std::string message_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// 5 x 3 texels, three views of one, no and two lights, everything there that can be.
inline BtfIndex small_index() {
  BtfIndex index{
      PairLayout({{0, 0}, {1.0 / 3, 359.99999999999994}, {60, 0.1}}, {{15, 0}, {85, 120}}, {{0, 1}, {1}, {}}),
      {5, 3, Vec2(0.01f, 0.005f)},
      Shell{0.1 + 0.2, 1e-5},
      "small \"tile\""};
  index.options = R"({"samples": 16, "seed": 3})";
  index.structure = index.errors = true;
  return index;
}

/// Random bits: every kind of half float is among them.
struct RandomBtf {
  BtfIndex index;
  std::vector<HalfBits> values, errors;
  std::vector<ViewStructure> structure;

  RandomBtf(BtfIndex of, uint64_t seed) : index(std::move(of)) {
    RandomStream random(seed, 0, 0);
    const uint64_t texels = index.grid.texels();
    values.resize(index.layout.pairs() * texels * 3);
    for (HalfBits& h : values) h = static_cast<HalfBits>(random.next_bits());
    errors.resize(index.errors ? index.layout.pairs() * texels : 0);
    for (HalfBits& h : errors) h = static_cast<HalfBits>(random.next_bits());
    if (!index.structure) return;
    structure.resize(index.layout.views().size());
    for (ViewStructure& s : structure) {
      for (auto* map : {&s.coverage, &s.height_mean, &s.height_spread}) {
        for (uint64_t t = 0; t < texels; ++t) map->push_back(random.next());
      }
    }
  }

  BtfView view(size_t v) const {
    const uint64_t texels = index.grid.texels(), first = index.layout.first(v), end = index.layout.first(v + 1);
    BtfView view{std::span(values).subspan(first * texels * 3, (end - first) * texels * 3)};
    if (index.errors) view.errors = std::span(errors).subspan(first * texels, (end - first) * texels);
    if (index.structure) view.structure = &structure[v];
    return view;
  }

  void write_view(const BtfFolderWriter& writer, uint32_t v) const { writer.write(v, view(v)); }

  void write(const std::string& path) const {
    const BtfFolderWriter writer(path, index, false);
    for (uint32_t v = 0; v < index.layout.views().size(); ++v) write_view(writer, v);
    writer.finish();
  }
};

inline std::vector<HalfBits> all_pairs(const BtfMeasurement& btf) {
  std::vector<HalfBits> values(btf.layout().pairs() * btf.grid().texels() * 3);
  btf.read_pairs(0, btf.layout().pairs(), values);
  return values;
}

}  // namespace velour::test
