// The kinds of BTF model that share SidedBtfMaterial, for tests that hold for all of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "btf/eval/sided_btf_material.h"
#include "support/example_srbf.h"
#include "support/glossy_tensor.h"

namespace velour::test {

struct SrbfKind {
  using Btf = SrbfBtf;
  static constexpr float kTolerance = 1e-3f;  // slopes are rounded to sixteen bits
  static Btf example(bool two_sided = false, Companding companding = Companding::root) {
    return example_srbf(two_sided, companding);
  }
  /// Both sides: a highlight of half vectors over a base.
  static Btf glossy() {
    Btf btf = example_srbf(true);
    for (SrbfSide& side : btf.sides) {
      side.lobes[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f, 0.0f, side.view_below ? 15.0f : 40.0f)};
      std::fill(side.scale.begin(), side.scale.end(), ByteScale{0.0f, 0.1f / 255});
      side.scale[0] = {0.2f, 0.2f / 255};  // of axis 0: the constant lobe and the highlight
      side.scale[3] = {0.8f, 0.6f / 255};
    }
    return btf;
  }
  /// f = `value` everywhere.
  static Btf even(float value) {
    Btf btf = example_srbf();
    btf.axes = Mat3(1.0f);
    SrbfSide& side = btf.sides[0];
    side.lobes = {{}};
    side.tile_lobes = 1;
    side.lobe = {{{0}, {0}, {0}}};
    side.scale.assign(3, {std::sqrt(value), 0.0f});
    for (SrbfLevel& level : side.levels) level.value.resize(size_t{level.width} * level.height * 3);
    return btf;
  }
  static void negate(Btf& btf) {
    for (ByteScale& scale : btf.sides[0].scale) scale = {-scale.least, -scale.step};
  }
  static std::shared_ptr<const Material> material(const Btf& btf) {
    return make_srbf_btf_material(std::make_shared<const Btf>(btf));
  }
};

struct TensorKind {
  using Btf = TensorBtf;
  static constexpr float kTolerance = 2e-5f;
  static Btf example(bool two_sided = false, Companding companding = Companding::root) {
    return example_tensor(two_sided, companding);
  }
  static Btf glossy() { return glossy_tensor(); }
  static Btf even(float value) {
    Btf btf = example_tensor(false, Companding::root, {1, 1, {1, 1, 1, 1}, false});
    btf.axes = Mat3(1.0f);
    TensorBtfCluster& cluster = btf.sides[0].clusters[0];
    for (auto* factor : {&cluster.view, &cluster.light, &cluster.color, &cluster.core}) {
      *factor = halves_of(std::vector<float>(factor->size(), 1.0f));
    }
    cluster.scale = {{std::sqrt(value), 0.0f}};
    return btf;
  }
  static void negate(Btf& btf) {
    for (TensorBtfCluster& cluster : btf.sides[0].clusters) {
      for (ByteScale& scale : cluster.scale) scale = {-scale.least, -scale.step};
    }
  }
  static std::shared_ptr<const Material> material(const Btf& btf) {
    return make_tensor_btf_material(std::make_shared<const Btf>(btf));
  }
};

using SidedBtfKinds = ::testing::Types<SrbfKind, TensorKind>;

/// For TYPED_TEST_SUITE.
struct SidedBtfNames {
  template <typename Kind>
  static std::string GetName(int) {
    return std::is_same_v<Kind, SrbfKind> ? "srbf" : "tensor";
  }
};

}  // namespace velour::test
