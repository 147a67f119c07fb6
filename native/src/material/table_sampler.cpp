#include "material/table_sampler.h"

#include <algorithm>
#include <vector>

#include "brdf/fast_atan2.h"
#include "job/parallel.h"
#include "material/defensive_share.h"
#include "material/half_vector_table.h"
#include "sphere/discrete_choice.h"
#include "sphere/warp.h"

namespace velour {

namespace {

constexpr int kMeridianViews = 90;
constexpr int kPolarViews = 16, kAzimuthViews = 32;

/// Tables about a view with weights that sum to 1, and the azimuth of the frame that they were made in.
struct ViewBlend {
  int count = 0;
  const HalfVectorTable* table[4];
  float weight[4], cdf[4];
  float cos_turn = 1, sin_turn = 0;

  void add(const HalfVectorTable& t, float w) {
    if (w <= 0) return;
    table[count] = &t;
    weight[count] = w;
    cdf[count] = (count > 0 ? cdf[count - 1] : 0) + w;
    ++count;
  }

  Vec3 to_local(const Vec3& h) const { return {cos_turn * h.x - sin_turn * h.y, sin_turn * h.x + cos_turn * h.y, h.z}; }
  Vec3 to_table(const Vec3& h) const { return {cos_turn * h.x + sin_turn * h.y, cos_turn * h.y - sin_turn * h.x, h.z}; }
};

/// A position between two of `nodes` >= 2 at 0, 1, 2, ...
struct GridPlace {
  GridPlace(float position, int nodes) {
    const float clamped = std::clamp(position, 0.0f, static_cast<float>(nodes - 1));
    low = std::min(static_cast<int>(clamped), nodes - 2);
    share = clamped - static_cast<float>(low);
  }

  int low;
  float share;  // of low + 1
};

}  // namespace

struct TableSampler::Tables {
  bool isotropic;
  std::vector<HalfVectorTable> views;  // azimuths of one polar angle side by side

  int polar_views() const { return isotropic ? kMeridianViews : kPolarViews; }
  int azimuth_views() const { return isotropic ? 1 : kAzimuthViews; }

  /// Polar angles at the middles of equal steps: none at the horizon.
  Vec3 view(int polar, int turn) const {
    const float theta = (static_cast<float>(polar) + 0.5f) / static_cast<float>(polar_views()) * kPi / 2;
    return direction(theta, static_cast<float>(turn) / static_cast<float>(azimuth_views()) * 2 * kPi);
  }

  ViewBlend blend(const Vec3& wv) const {
    const float sine = std::sqrt(wv.x * wv.x + wv.y * wv.y);
    const float steps = fast_atan2(sine, wv.z) / (kPi / 2) * static_cast<float>(polar_views());
    const GridPlace polar(steps - 0.5f, polar_views());
    ViewBlend set;
    if (isotropic) {
      set.add(views[static_cast<size_t>(polar.low)], 1 - polar.share);
      set.add(views[static_cast<size_t>(polar.low) + 1], polar.share);
      if (sine > 0) set.cos_turn = wv.x / sine, set.sin_turn = wv.y / sine;
    } else {
      const float turn = fast_atan2(wv.y, wv.x) / (2 * kPi);
      const GridPlace azimuth((turn < 0 ? turn + 1 : turn) * kAzimuthViews, kAzimuthViews + 1);
      for (int i = 0; i < 4; ++i) {
        const int p = i / 2, t = i % 2;
        const int index = (polar.low + p) * kAzimuthViews + (azimuth.low + t) % kAzimuthViews;
        set.add(views[static_cast<size_t>(index)],
                (p ? polar.share : 1 - polar.share) * (t ? azimuth.share : 1 - azimuth.share));
      }
    }
    set.cdf[set.count - 1] = 1;
    return set;
  }
};

TableSampler::TableSampler(const Material& material) {
  auto tables = std::make_unique<Tables>();
  tables->isotropic = material.isotropic();
  const int turns = tables->azimuth_views();
  tables->views.resize(static_cast<size_t>(tables->polar_views() * turns));
  parallel_fill(tables->views.size(), [&](size_t i) {
    const int view = static_cast<int>(i);
    tables->views[i].tabulate(material, tables->view(view / turns, view % turns));
  });
  tables_ = std::move(tables);
}

TableSampler::~TableSampler() = default;

Vec3 TableSampler::sample(const Vec3& wv, const Vec2& u) const {
  double rest = middle_of_step(u.x);
  if (rest < kDefensiveShare) {
    const float u_cosine = std::min(static_cast<float>(rest / kDefensiveShare), 1 - 0x1p-24f);
    return sample_cosine_hemisphere({u_cosine, u.y});
  }
  rest = (rest - kDefensiveShare) / (1 - static_cast<double>(kDefensiveShare));
  const ViewBlend set = tables_->blend(wv);
  const int chosen = choose_index(set.cdf, set.count, rest);
  const Vec3 h = set.to_local(set.table[chosen]->sample(rest, u.y));
  return 2 * glm::dot(wv, h) * h - wv;
}

void TableSampler::pdf(const Vec3& wv, const DirectionBatch& wl, ScalarBatch& pdf) const {
  const ViewBlend set = tables_->blend(wv);
  for (int i = 0; i < wl.count; ++i) {
    const Vec3 w = wl.get(i), sum = w + wv;
    const float length = glm::length(sum);
    pdf.v[i] = kDefensiveShare * pdf_cosine_hemisphere(w);
    if (length <= 0) continue;
    // h and -h mirror wv to the same wl; the tables hold the one above the horizon.
    const Vec3 h = set.to_table(sum.z >= 0 ? sum / length : -sum / length);
    const HalfVectorTable::Cell cell = HalfVectorTable::cell_of(h);
    float density = 0;
    for (int k = 0; k < set.count; ++k) density += set.weight[k] * set.table[k]->pdf(cell);
    pdf.v[i] += (1 - kDefensiveShare) * density / (4 * std::max(0.5f * length, 1e-7f));  // wv.h = |wl + wv| / 2
  }
}

uint64_t TableSampler::bytes() const { return sizeof(Tables) + tables_->views.size() * sizeof(HalfVectorTable); }

}  // namespace velour
