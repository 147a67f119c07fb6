#include "btf/eval/sided_btf_material.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "math/srbf/kernel.h"

namespace velour {

namespace {

// Best or second best by variance under uniform light for both a glossy weave and gravel, among bandwidths of 6 to 13
// and tilts of 45 to 60 degrees. Nineteen lobes gain another tenth at three times the evaluations.
constexpr float kBandwidth = 8.0f, kTilt = 0.85f;
constexpr int kBroad = BtfLook::kBroad, kHalf = kBroad, kLobes = kBroad + 1;
constexpr float kMinReliefCosine = 0.05f;  // between view and relief normal; no visible highlight below it

struct BroadLobes {
  std::array<Vec3, kBroad> center;
  std::array<float, kBroad> share;  // own value at its center over the sum of all lobes there, at equal strengths

  BroadLobes() {
    center[0] = Vec3(0, 0, 1);
    for (int i = 1; i < kBroad; ++i) {
      center[static_cast<size_t>(i)] = direction(kTilt, 2 * kPi * static_cast<float>(i - 1) / (kBroad - 1));
    }
    for (size_t i = 0; i < kBroad; ++i) {
      float all = 0;
      for (const Vec3& other : center) all += kernel(other, center[i]);
      share[i] = 1 / all;
    }
  }
  static float kernel(const Vec3& center, const Vec3& w) { return std::exp(kBandwidth * (glm::dot(center, w) - 1)); }
};
const BroadLobes kBroadLobes;

float integral(float bandwidth) { return static_cast<float>(kernel_integral(Kernel::gaussian, bandwidth)); }

void set_lobe(WarpedMixture& m, int j, const Vec3& center, float bandwidth, bool half) {
  m.half[j] = half ? 1.0f : 0.0f;
  m.s_xx[j] = m.s_yy[j] = 1;
  m.s_xy[j] = 0;
  m.x[j] = m.draw_x[j] = center.x;
  m.y[j] = m.draw_y[j] = center.y;
  m.z[j] = m.draw_z[j] = center.z;
  m.bandwidth[j] = m.draw_bandwidth[j] = bandwidth;
  m.draw_tail[j] = std::exp(-2 * bandwidth);
  m.r[j] = m.g[j] = m.b[j] = 0;
}

/// Estimated integral of each lobe.
std::array<float, kLobes> masses(const BtfLook& look, float half_bandwidth) {
  std::array<float, kLobes> mass;
  const Vec3 mirror = BtfDraws::mirror(look.wv, look.normal);
  float broad = 0;
  const float broad_integral = 2 * kPi / kBandwidth;
  for (size_t i = 0; i < kBroad; ++i) {
    const float strength = kBroadLobes.share[i] * look.broad[i];
    broad += strength * BroadLobes::kernel(kBroadLobes.center[i], mirror);
    mass[i] = strength * broad_integral;
  }
  mass[kHalf] = 0;
  const float cosine = glm::dot(look.wv, look.normal);
  if (half_bandwidth > 0 && cosine > kMinReliefCosine) {
    const float beyond = std::max(look.mirror - broad, 0.0f);
    mass[kHalf] =
        beyond * 4 * cosine * (2 * kPi / half_bandwidth);  // Jacobian of half-vector lobes: docs/engine/equations.md
  }
  return mass;
}

void fill_mixture(const BtfLook& look, const std::array<float, kLobes>& mass, float half_bandwidth, float cosine_share,
                  WarpedMixture& m) {
  float all = 0;
  for (const float x : mass) all += x;
  m.count = kLobes;
  m.padded = WarpedMixture::padded_of(kLobes);
  m.turn_cos = 1;
  m.turn_sin = 0;
  m.wv = look.wv;
  m.list_all();
  // Plain cosine sampling where all queried values are 0.
  const float cosine = all > 0 ? cosine_share : 1.0f;
  m.sums[WarpedMixture::kSums - 2] = 0;
  m.sums[WarpedMixture::kSums - 1] = cosine;
  const float bandwidth = std::max(half_bandwidth, 1.0f), half_integral = integral(bandwidth);
  static const float broad_integral = integral(kBandwidth);
  float sum = cosine;
  for (int j = 0; j < m.padded; ++j) {
    const bool broad = j < kBroad;
    const float probability = j < kLobes && all > 0 ? (1 - cosine) * mass[static_cast<size_t>(j)] / all : 0.0f;
    set_lobe(m, j, broad ? kBroadLobes.center[static_cast<size_t>(j)] : look.normal, broad ? kBandwidth : bandwidth,
             !broad);
    m.density[j] = probability / (broad ? broad_integral : half_integral);
    m.sums[WarpedMixture::kSums + j] = sum += probability;
  }
}

std::vector<Vec3> spread_by_cosine() {
  constexpr uint32_t kLights = 256;
  std::vector<Vec3> lights;
  for (uint32_t i = 0; i < kLights; ++i) {
    RandomStream random(0, i, 1);
    lights.push_back(sample_cosine_hemisphere(random.next2()));
  }
  return lights;
}

/// Sum over the examples of the log of (1 + relative variance) of one sample under uniform light.
double cost_of(const std::vector<BtfDraws::Example>& examples, float half_bandwidth, float cosine_share) {
  const std::vector<Vec3>& lights = BtfDraws::even_lights();
  double cost = 0;
  for (const BtfDraws::Example& example : examples) {
    WarpedMixture mixture;
    fill_mixture(example.look, masses(example.look, half_bandwidth), half_bandwidth, cosine_share, mixture);
    double first = 0, second = 0;
    for (size_t l = 0; l < lights.size(); ++l) {
      Rgb none;
      float pdf;
      eval_warped(mixture, lights[l], none, pdf);
      const double cosine = static_cast<double>(pdf_cosine_hemisphere(lights[l])),
                   f = static_cast<double>(example.f[l]);
      first += f / cosine;
      second += f * f / (cosine * static_cast<double>(pdf));
    }
    if (first > 0) cost += std::log(second * static_cast<double>(lights.size()) / (first * first));
  }
  return cost;
}

}  // namespace

const std::vector<Vec3>& BtfDraws::even_lights() {
  static const std::vector<Vec3> lights = spread_by_cosine();
  return lights;
}

const std::array<Vec3, BtfLook::kBroad>& BtfDraws::centers() { return kBroadLobes.center; }

BtfDraws::BtfDraws(const std::vector<Example>& examples) {
  double least = std::numeric_limits<double>::infinity();
  for (const float bandwidth : {0.0f, 15.0f, 30.0f, 60.0f, 120.0f, 240.0f, 480.0f}) {
    for (const float share : {1.0f, 0.7f, 0.4f, 0.2f, 0.1f}) {
      const double cost = cost_of(examples, bandwidth, share);
      if (!(cost < least)) continue;
      least = cost;
      half_bandwidth_ = bandwidth;
      cosine_share_ = share;
    }
  }
}

bool BtfDraws::asks_mirror(const Vec3& wv, const Vec3& normal) const {
  return asks() && half_bandwidth_ > 0 && glm::dot(wv, normal) > kMinReliefCosine;
}

void BtfDraws::fill(const BtfLook& look, WarpedMixture& mixture) const {
  std::array<float, kLobes> mass{};
  if (asks()) mass = masses(look, half_bandwidth_);
  fill_mixture(look, mass, half_bandwidth_, cosine_share_, mixture);
}

void BtfDraws::propose(const WarpedMixture& mixture, ProposalLobes& lobes) {
  static_assert(kLobes <= ProposalLobes::kCapacity);
  lobes.cosine = mixture.cosine() / kPi;
  lobes.count = 0;
  for (int j = 0; j < kBroad; ++j) {
    lobes.lobe[lobes.count++] = {
        {mixture.draw_x[j], mixture.draw_y[j], mixture.draw_z[j]}, kBandwidth, mixture.density[j]};
  }
  const Vec3 normal(mixture.draw_x[kHalf], mixture.draw_y[kHalf], mixture.draw_z[kHalf]);
  const float cosine = glm::dot(normal, mixture.wv);
  if (!(mixture.density[kHalf] > 0)) return;
  // Near the mirror direction the half vector turns by half the light's angle, and solid angles shrink by 4 cosine.
  lobes.lobe[lobes.count++] = {2 * cosine * normal - mixture.wv, mixture.draw_bandwidth[kHalf] / (4 * cosine),
                               mixture.density[kHalf] / (4 * cosine)};
}

namespace {

// Measured on woven cloth and on chain mail of 64 texels: half the cells raise the variance by 7 %, three views per
// side by 4 %; six gain nothing.
constexpr uint32_t kMaxCells = 64;  // along both axes
constexpr uint32_t kViewCells = 4;  // along both axes of the disk
constexpr float kRim = 0.95f;       // maximum radius of a view on the disk

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
  cells_ = std::min(std::bit_ceil(static_cast<uint32_t>(most)), kMaxCells);
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

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<SrbfEvaluator>>(std::move(btf), light);
}

std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<TensorEvaluator>>(std::move(btf), light);
}

namespace {

/// The BTF at a point close to a silhouette.
class PreparedFold final : public PreparedBrdf {
 public:
  /// `beyond`: the point mirrored in the silhouette; only its value is used.
  PreparedFold(const PreparedBrdf* inside, const PreparedBrdf* beyond) : inside_(inside), beyond_(beyond) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    beyond_->eval(wl, f, pdf);
    RgbBatch inside;
    inside_->eval(wl, inside, pdf);
    for (int i = 0; i < wl.count; ++i) f.set(i, inside.get(i) + f.get(i));
  }
  Reflection eval_one(const Vec3& wl) const override {
    Reflection sum = inside_->eval_one(wl);
    sum.f += beyond_->eval_one(wl).f;
    return sum;
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { inside_->sample(u, wl); }
  Vec3 sample_one(const Vec2& u) const override { return inside_->sample_one(u); }
  float diffuse_share(const Vec3& wl, float pdf) const override { return inside_->diffuse_share(wl, pdf); }
  bool proposal_lobes(ProposalLobes& lobes) const override { return inside_->proposal_lobes(lobes); }

 private:
  const PreparedBrdf *inside_, *beyond_;
};

}  // namespace

const PreparedBrdf* HoledBtfMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                              ScratchArena& arena) const {
  const PreparedBrdf* const inside = btf_->prepare(wv, site, options, arena);
  if (site.beyond_outline == Vec2(0.0f)) return inside;
  SurfaceSite beyond = site;
  beyond.uv += site.beyond_outline;
  PrepareOptions value_only = options;
  value_only.value_only = true;
  return arena.make<PreparedFold>(inside, btf_->prepare(wv, beyond, value_only, arena));
}

}  // namespace velour
