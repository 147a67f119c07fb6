// No kind of material uses the heap at a hit, once the arena has seen the largest.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "brdf/eval/parametric_material.h"
#include "btf/eval/factored_material.h"
#include "material/bsdf_materials.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/example_btf.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/striped_btf.h"
#include "support/through_btfs.h"

namespace {

std::atomic<uint64_t> allocations{0};

void* counted(size_t bytes, size_t alignment) {
  ++allocations;
  void* const memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// The library's calls come here too: a program's operators replace those of all its libraries.
void* operator new(size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(size_t bytes, std::align_val_t alignment) { return counted(bytes, static_cast<size_t>(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { std::free(memory); }

namespace velour::allocation_test {
namespace {

/// Prepares points in batches, as the renderer does, and calls everything that they offer.
void use(const Material& material, bool interpolated, ScratchArena& arena) {
  constexpr uint32_t kBatches = 24, kPoints = 8, kDirections = 16;
  for (uint32_t batch = 0; batch < kBatches; ++batch) {
    arena.reset();
    for (uint32_t i = 0; i < kPoints; ++i) {
      RandomStream random(1, batch, i);
      SurfaceSite site{.uv = random.next2(), .footprint = Mat2(0.3f * random.next())};
      site.back = i % 2 == 1;
      site.beyond_outline = Vec2(i % 3 == 0 ? 0.1f : 0.0f);
      site.relief = Mat3(1.0f);
      const Vec3 wv = sample_cosine_hemisphere(random.next2());
      const PreparedBrdf* const point = material.prepare(wv, site, {.interpolated_draws = interpolated}, arena);
      Vec2 u[kDirections];
      for (Vec2& v : u) v = random.next2();
      DirectionBatch wl;
      point->sample(u, wl);
      wl.pad();
      RgbBatch f;
      ScalarBatch pdf;
      point->eval(wl, f, pdf);
      const Vec3 one = point->sample_one(u[0]);
      ProposalLobes lobes;
      point->proposal_lobes(lobes);
      point->diffuse_share(one, point->eval_one(one).pdf);
    }
  }
}

uint64_t allocations_at_hits(const Material& material, bool interpolated = false) {
  ScratchArena arena;
  for (int i = 0; i < 2; ++i) use(material, interpolated, arena);
  const uint64_t before = allocations;
  use(material, interpolated, arena);
  return allocations - before;
}

using Shared = std::shared_ptr<const Material>;

template <typename Kind>
Shared sided() {
  return test::through_material<Kind>(test::with_through(Kind::example(true)));
}

struct Named {
  const char* name;
  std::function<Shared()> make;
  bool interpolated = false;
};

Shared parametric() { return make_parametric_material(test::parametric_highlight(100, true)); }
Shared per_view() { return test::highlight_material(100); }

std::vector<Named> kinds() {
  return {
      {"parametric", parametric},
      {"parametric of narrow lobes", [] { return make_parametric_material(test::parametric_highlight(1e6f, true)); }},
      {"per-view", per_view},
      {"per-view, interpolated", per_view, true},
      {"measured, per-view", [] { return test::measured(test::isotropic_model()); }},
      {"measured, parametric",
       [] {
         return make_measured_material(std::make_shared<test::SyntheticMeasurement>(),
                                       test::parametric_highlight(100, true));
       }},
      {"glossy", [] { return make_glossy_material({}); }},
      {"rough diffuse", [] { return make_rough_diffuse_material({.roughness = 0.5f}); }},
      {"principled", [] { return make_principled_material({.coat = 0.5f}); }},
      {"ggx", [] { return make_ggx_material({.alpha = Vec2(0.3f), .f0 = Rgb(0.5f)}); }},
      {"normal-mapped", [] { return make_normal_mapped(make_glossy_material({}), {}, ReliefPart::lobe); }},
      {"mixed",
       [] {
         ShaderLayers inner;
         inner.reflecting = {{per_view(), {{{.value = 0.5f}}}}, {make_glossy_material({}), {{{.value = 0.5f}}}}};
         ShaderLayers outer;
         outer.reflecting = {{make_layered_material(inner), {}}, {parametric(), {}}};
         return make_layered_material(outer);
       }},
      {"uncompressed BTF",
       [] {
         return make_measured_btf_material(read_btf_table(test::striped_btf({6, 4, Vec2(0.01f)}, true)));
       }},
      {"factored BTF",
       [] {
         return make_factored_material(
             std::make_shared<const FactoredBtf>(test::example_factored(true, Companding::root, true)));
       }},
      {"SRBF BTF with transmission", sided<test::SrbfKind>},
      {"tensor BTF with transmission", sided<test::TensorKind>},
      {"BTF with holes", [] { return std::make_shared<const HoledBtfMaterial>(sided<test::SrbfKind>()); }}};
}

class Allocation : public ::testing::TestWithParam<Named> {};

TEST_P(Allocation, HitsUseNoHeap) {
  const Shared material = GetParam().make();
  EXPECT_EQ(allocations_at_hits(*material, GetParam().interpolated), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, Allocation, ::testing::ValuesIn(kinds()), [](const auto& kind) {
  std::string name;
  for (const char c : std::string(kind.param.name)) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

/// Allocates at each point, in the library and not.
class Allocating final : public Material {
 public:
  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    ScratchArena own;
    return material_->prepare(wv, site, options, own.make_array<float>(1).empty() ? own : arena);
  }
  bool isotropic() const override { return true; }

 private:
  Shared material_ = make_glossy_material({});
};

TEST(AllocationControl, AMaterialThatAllocatesIsSeen) { EXPECT_GT(allocations_at_hits(Allocating()), 0u); }

}  // namespace
}  // namespace velour::allocation_test
