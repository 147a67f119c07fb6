#include "material/shader_layers.h"

#include <algorithm>

#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {
namespace {

constexpr uint32_t kAlbedoViews = 32, kAlbedoDraws = 32;

float brightest(const Rgb& c) { return std::max({c.r, c.g, c.b, 0.0f}); }

/// Mean albedo (luminance) over random views of the whole surface, estimated with the material's own samples.
float mean_albedo(const Material& material) {
  ScratchArena arena;
  double sum = 0;
  for (uint32_t i = 0; i < kAlbedoViews; ++i) {
    RandomStream random(1, i, 0);
    arena.reset();
    const PreparedBrdf* const point = material.prepare(sample_cosine_hemisphere(random.next2()), arena);
    Vec2 u[kAlbedoDraws];
    for (Vec2& point_of_square : u) point_of_square = random.next2();
    DirectionBatch wl;
    point->sample(u, wl);
    wl.pad();
    RgbBatch f;
    ScalarBatch pdf;
    point->eval(wl, f, pdf);
    for (int k = 0; k < wl.count; ++k) {
      if (pdf.v[k] > 0) sum += static_cast<double>(luminance(f.get(k)) * std::abs(wl.z[k]) / pdf.v[k]);
    }
  }
  return static_cast<float>(sum / (kAlbedoViews * kAlbedoDraws));
}

/// A reflecting layer at a point.
struct PreparedLayer {
  const PreparedBrdf* point;  // null: the layer is absent
  Rgb weight;                 // factor of its f
  float share;                // probability of sampling this layer; all sum to 1
  const Mat3* to_working;     // conversion of its f to the working space; null: none
  bool above_only;            // the material transmits light, but not this layer
  DeltaLobes deltas;          // of its own; empty unless PrepareOptions::of_path

  bool is_sampled() const { return point != nullptr && share > 0; }
  /// `c`, a share of the layer's light, in the working space.
  Rgb in_working_space(const Rgb& c) const { return to_working != nullptr ? *to_working * c : c; }
};

/// Keeps the lobes of the largest masses.
class StrongestLobes {
 public:
  explicit StrongestLobes(ProposalLobes& lobes) : lobes_(lobes) {
    lobes_.cosine = 0;
    lobes_.count = 0;
  }

  void add(const ProposalLobes& others, float weight) {
    lobes_.cosine += weight * others.cosine;
    for (int j = 0; j < others.count; ++j) {
      GaussianLobe lobe = others.lobe[j];
      lobe.amplitude *= weight;
      add(lobe);
    }
  }

 private:
  static float mass(const GaussianLobe& lobe) { return lobe.amplitude / std::max(lobe.bandwidth, 1.0f); }

  void add(const GaussianLobe& lobe) {
    if (lobes_.count < ProposalLobes::kCapacity) {
      lobes_.lobe[lobes_.count++] = lobe;
      return;
    }
    GaussianLobe& weakest = *std::ranges::min_element(lobes_.lobe, {}, mass);
    if (mass(weakest) < mass(lobe)) weakest = lobe;
  }

  ProposalLobes& lobes_;
};

class PreparedLayers final : public PreparedBrdf {
 public:
  explicit PreparedLayers(std::span<const PreparedLayer> layers) : layers_(layers) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    RgbBatch one;
    ScalarBatch one_pdf;
    bool first = true;
    for (const PreparedLayer& layer : layers_) {
      if (layer.point == nullptr) continue;
      layer.point->eval(wl, one, one_pdf);
      if (layer.above_only) leave_out_below(wl, one, one_pdf);
      for (int k = 0; k < wl.count; ++k) {
        const Rgb own = layer.in_working_space(one.get(k));
        f.set(k, (first ? Rgb(0.0f) : f.get(k)) + layer.weight * own);
        pdf.v[k] = (first ? 0.0f : pdf.v[k]) + layer.share * one_pdf.v[k];
      }
      first = false;
    }
    if (first) eval_black(wl, f, pdf);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.count = static_cast<int>(u.size());
    const PreparedLayer* last = nullptr;
    for (const PreparedLayer& layer : layers_) last = layer.is_sampled() ? &layer : last;
    if (last == nullptr) return wl.fill(u, sample_cosine_hemisphere);
    float begin = 0;
    for (const PreparedLayer& layer : layers_) {
      if (!layer.is_sampled()) continue;
      const float end = &layer == last ? 1.0f : begin + layer.share;
      sample_layer(layer, {begin, end}, u, wl);
      begin = end;
    }
  }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    float density = 0;
    for (const PreparedLayer& layer : layers_) {
      if (layer.point == nullptr) continue;
      const float own = layer.above_only && wl.z < 0 ? 0.0f : layer.point->eval_one(wl).pdf;
      if (own > 0) density += layer.share * own * layer.point->diffuse_share(wl, own);
    }
    return std::min(density / pdf, 1.0f);
  }

  void delta_lobes(DeltaLobes& lobes) const override {
    lobes.count = 0;
    lobes.rest = 0;
    for (const PreparedLayer& layer : layers_) {
      if (layer.point == nullptr) continue;
      lobes.rest += layer.deltas.rest;
      for (int i = 0; i < layer.deltas.count; ++i) {
        const DeltaLobes::Lobe& own = layer.deltas.lobe[i];
        lobes.add(own.wl, layer.weight * layer.in_working_space(own.weight));
      }
    }
  }

  bool proposal_lobes(ProposalLobes& lobes) const override {
    StrongestLobes strongest(lobes);
    bool any = false;
    for (const PreparedLayer& layer : layers_) {
      ProposalLobes own;
      if (layer.point == nullptr) continue;
      if (!layer.point->proposal_lobes(own)) return false;
      strongest.add(own, luminance(layer.weight));
      any = true;
    }
    return any;
  }

 private:
  static void leave_out_below(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) {
    for (int i = 0; i < wl.count; ++i) {
      if (!(wl.z[i] < 0)) continue;
      f.set(i, Rgb(0.0f));
      pdf.v[i] = 0;
    }
  }

  static void eval_black(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, Rgb(0.0f));
      pdf.v[i] = std::max(wl.z[i], 0.0f) / kPi;
    }
  }

  /// Samples `layer` for those `u` whose first coordinate lies in `range`.
  static void sample_layer(const PreparedLayer& layer, const Vec2& range, std::span<const Vec2> u, DirectionBatch& wl) {
    Vec2 some[DirectionBatch::kCapacity];
    int place[DirectionBatch::kCapacity];
    size_t count = 0;
    for (size_t i = 0; i < u.size(); ++i) {
      if (u[i].x < range.x || u[i].x >= range.y) continue;
      place[count] = static_cast<int>(i);
      some[count++] = {std::min((u[i].x - range.x) / (range.y - range.x), 1 - 0x1p-24f), u[i].y};
    }
    if (count == 0) return;
    DirectionBatch drawn;
    layer.point->sample({some, count}, drawn);
    for (size_t i = 0; i < count; ++i) {
      const Vec3 w = drawn.get(static_cast<int>(i));
      wl.set(place[i], layer.above_only && w.z < 0 ? Vec3(0.0f) : w);
    }
  }

  std::span<const PreparedLayer> layers_;
};

class LayeredMaterial final : public Material {
 public:
  explicit LayeredMaterial(ShaderLayers layers) : layers_(std::move(layers)) {
    for (const ReflectingLayer& l : layers_.reflecting) {
      albedo_.push_back(std::max(mean_albedo(*l.material), 1e-3f));
      transmits_ = transmits_ || l.material->transmits();
      texels_ = glm::max(texels_, l.material->texels());
    }
  }

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const std::span<PreparedLayer> prepared = arena.make_array<PreparedLayer>(albedo_.size());
    const float brighter = 1 / there(site);
    float sum = 0;
    for (size_t i = 0; i < albedo_.size(); ++i) {
      PreparedLayer& layer = prepared[i];
      const ReflectingLayer& from = layers_.reflecting[i];
      layer.weight = Rgb(brighter * std::max(from.weight.at(site), 0.0f)) * from.weight.tint(site);
      if (from.top) layer.weight *= from.top->through(wv, site, options.filter);
      layer.to_working = from.rec709_colors && layers_.rec709_to_working ? &*layers_.rec709_to_working : nullptr;
      layer.above_only = transmits_ && !from.material->transmits();
      const Vec3 view = from.lifts_views ? above_horizon(wv) : wv;
      layer.point = layer.weight != Rgb(0.0f) ? from.material->prepare(view, site, options, arena) : nullptr;
      layer.share = luminance(layer.weight) * albedo_[i];
      if (options.of_path && layer.point != nullptr) {
        layer.point->delta_lobes(layer.deltas);
        if (layer.deltas.rest <= 0) layer.share = 0;
        layer.deltas.rest = layer.share;
      }
      sum += layer.share;
    }
    for (size_t i = 0; i < albedo_.size() && sum > 0; ++i) prepared[i].share /= sum;
    return arena.make<PreparedLayers>(prepared);
  }

  bool varies() const override {
    const auto varies = [](const ColorLayer& l) { return l.varies(); };
    return std::ranges::any_of(layers_.transparent, varies) || std::ranges::any_of(layers_.emissive, varies) ||
           std::ranges::any_of(layers_.reflecting, [](const ReflectingLayer& l) {
             return l.weight.varies() || l.material->varies() || (l.top && l.top->textures.varies());
           });
  }

  Vec2 texels() const override { return texels_; }
  bool transmits() const override { return transmits_; }

  bool opaque() const override { return layers_.transparent.empty(); }
  bool tints() const override { return !opaque(); }
  float alpha(const SurfaceSite& site) const override {
    const float through = brightest(let_through(site));
    return through > 0 ? stopping(site) / (stopping(site) + through) : 1.0f;
  }
  Rgb passing(const SurfaceSite& site) const override {
    const Rgb color = let_through(site);
    const float through = brightest(color);
    if (!(through > 0)) return Rgb(1.0f);
    const Rgb passed = color * ((stopping(site) + through) / through);
    return glm::distance(passed, Rgb(1.0f)) < 1e-5f ? Rgb(1.0f) : passed;  // rounding errors of mixes with white
  }

  bool emits() const override { return !layers_.emissive.empty(); }
  Rgb emission(const SurfaceSite& site) const override {
    Rgb sum(0.0f);
    for (const ColorLayer& l : layers_.emissive) sum += l.at(site);
    return sum == Rgb(0.0f) ? sum : sum / there(site);
  }

  bool isotropic() const override {
    return std::ranges::all_of(layers_.reflecting, [](const ReflectingLayer& l) { return l.material->isotropic(); });
  }

 private:
  Rgb let_through(const SurfaceSite& site) const {
    Rgb sum(0.0f);
    for (const ColorLayer& l : layers_.transparent) sum += l.at(site);
    return sum;
  }
  /// Decides how many rays meet the surface. An emissive layer need not stop more rays than a wall does.
  float stopping(const SurfaceSite& site) const {
    float sum = 0;
    for (const ReflectingLayer& l : layers_.reflecting) sum += l.weight.at(site);
    for (const ColorLayer& l : layers_.emissive) sum += std::min(std::abs(l.weight.at(site)), 1.0f);
    return sum;
  }
  /// alpha(), or 1 where it is 0 and the layers are not evaluated.
  float there(const SurfaceSite& site) const {
    if (opaque()) return 1.0f;
    const float a = alpha(site);
    return a > 0 ? a : 1.0f;
  }

  const ShaderLayers layers_;
  std::vector<float> albedo_;  // mean albedo of each reflecting layer; only steers sampling
  Vec2 texels_{1.0f};          // of the finest layer along each coordinate
  bool transmits_ = false;
};

}  // namespace

Rgb PrincipledTop::through(const Vec3& wv, const SurfaceSite& site, const LobeFilter& filter) const {
  const auto cosine = [&](const std::optional<NormalMap>& map) {
    return map ? std::max(glm::dot(wv, map->normal(true, wv, site)), kMinViewCosine) : above_horizon(wv).z;
  };
  const PrincipledParameters at = textures.varies() ? textures.at(site, parameters) : parameters;
  return through_top(at, cosine(normal), cosine(coat_normal), filter);
}

float LayerLevel::share(float at) const {
  if (at < peak) return begin < peak ? std::max((at - begin) / (peak - begin), 0.0f) : 1.0f;
  return end > peak ? std::max((end - at) / (end - peak), 0.0f) : 1.0f;
}

float LayerFactor::at(const SurfaceSite& site) const {
  if (kind == Kind::level) return level.share(texture.at_point(site, value));
  const float given = texture.at(site, value);
  if (kind == Kind::gain) return given;
  const float share = std::clamp(given, 0.0f, 1.0f);
  return kind == Kind::rest ? 1 - share : share;
}

float LayerWeight::at(const SurfaceSite& site) const {
  float product = 1;
  for (const LayerFactor& f : factors) product *= f.at(site);
  return product;
}

Rgb LayerWeight::tint(const SurfaceSite& site) const {
  Rgb product(1.0f);
  for (const LayerTint& t : tints) product *= glm::max(t.at(site), Rgb(0.0f));
  return product;
}

bool LayerWeight::varies() const {
  const auto given = [](const auto& factor) { return factor.texture.given(); };
  return std::ranges::any_of(factors, given) || std::ranges::any_of(tints, given);
}

std::shared_ptr<const Material> make_layered_material(ShaderLayers layers) {
  return std::make_shared<LayeredMaterial>(std::move(layers));
}

}  // namespace velour
