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
  const auto point = std::make_unique<PreparedBrdf>();
  double sum = 0;
  for (uint32_t i = 0; i < kAlbedoViews; ++i) {
    RandomStream random(1, i, 0);
    material.prepare(sample_cosine_hemisphere(random.next2()), *point);
    Vec2 u[kAlbedoDraws];
    for (Vec2& point_of_square : u) point_of_square = random.next2();
    DirectionBatch wl;
    material.sample(*point, u, wl);
    wl.pad();
    RgbBatch f;
    ScalarBatch pdf;
    material.eval(*point, wl, f, pdf);
    for (int k = 0; k < wl.count; ++k) {
      if (pdf.v[k] > 0) sum += static_cast<double>(luminance(f.get(k)) * std::abs(wl.z[k]) / pdf.v[k]);
    }
  }
  return static_cast<float>(sum / (kAlbedoViews * kAlbedoDraws));
}

class LayeredMaterial final : public Material {
 public:
  explicit LayeredMaterial(ShaderLayers layers) : layers_(std::move(layers)) {
    for (const ReflectingLayer& l : layers_.reflecting) albedo_.push_back(std::max(mean_albedo(*l.material), 1e-3f));
  }

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    if (point.layers.size() < albedo_.size()) point.layers.resize(albedo_.size());
    const float brighter = 1 / there(site);
    float sum = 0;
    for (size_t i = 0; i < albedo_.size(); ++i) {
      PreparedLayer& layer = point.layers[i];
      const ReflectingLayer& from = layers_.reflecting[i];
      layer.weight = Rgb(brighter * from.weight.at(site));
      if (from.coated) layer.weight *= through_coat(*from.coated, wv.z, point.filter);
      sum += layer.share = luminance(layer.weight) * albedo_[i];
      if (!layer.is_there()) continue;
      if (!layer.point) layer.point = std::make_unique<PreparedBrdf>();
      layer.point->interpolated_draws = point.interpolated_draws;
      layer.point->filter = point.filter;
      from.material->prepare(wv, site, *layer.point);
    }
    for (size_t i = 0; i < albedo_.size() && sum > 0; ++i) point.layers[i].share /= sum;
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    RgbBatch one;
    ScalarBatch one_pdf;
    bool first = true;
    for (size_t i = 0; i < albedo_.size(); ++i) {
      const PreparedLayer& layer = point.layers[i];
      if (!layer.is_there()) continue;
      layers_.reflecting[i].material->eval(*layer.point, wl, one, one_pdf);
      for (int k = 0; k < wl.count; ++k) {
        f.set(k, (first ? Rgb(0.0f) : f.get(k)) + layer.weight * one.get(k));
        pdf.v[k] = (first ? 0.0f : pdf.v[k]) + layer.share * one_pdf.v[k];
      }
      first = false;
    }
    if (first) eval_black(wl, f, pdf);
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.count = static_cast<int>(u.size());
    bool drawn = false;
    float begin = 0;
    for (size_t i = 0; i < albedo_.size(); ++i) {
      if (!point.layers[i].is_there()) continue;
      const bool last = std::none_of(point.layers.begin() + static_cast<ptrdiff_t>(i) + 1,
                                     point.layers.begin() + static_cast<ptrdiff_t>(albedo_.size()),
                                     [](const PreparedLayer& l) { return l.is_there(); });
      const float end = last ? 1.0f : begin + point.layers[i].share;
      sample_layer(point, i, {begin, end}, u, wl);
      begin = end;
      drawn = true;
    }
    if (!drawn) wl.fill(u, sample_cosine_hemisphere);
  }

  float diffuse_share(const PreparedBrdf& point, const Vec3& wl, float pdf) const override {
    float density = 0;
    for (size_t i = 0; i < albedo_.size(); ++i) {
      const PreparedLayer& layer = point.layers[i];
      if (!layer.is_there()) continue;
      const Material& material = *layers_.reflecting[i].material;
      const float own = material.eval_one(*layer.point, wl).pdf;
      if (own > 0) density += layer.share * own * material.diffuse_share(*layer.point, wl, own);
    }
    return std::min(density / pdf, 1.0f);
  }

  bool varies() const override {
    const auto varies = [](const ColorLayer& l) { return l.varies(); };
    return std::ranges::any_of(layers_.transparent, varies) || std::ranges::any_of(layers_.emissive, varies) ||
           std::ranges::any_of(layers_.reflecting,
                               [](const ReflectingLayer& l) { return l.weight.varies() || l.material->varies(); });
  }

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
    for (const ColorLayer& l : layers_.emissive) sum += std::min(l.weight.at(site), 1.0f);
    return sum;
  }
  /// alpha(), or 1 where it is 0 and the layers are not evaluated.
  float there(const SurfaceSite& site) const {
    if (opaque()) return 1.0f;
    const float a = alpha(site);
    return a > 0 ? a : 1.0f;
  }

  static void eval_black(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, Rgb(0.0f));
      pdf.v[i] = std::max(wl.z[i], 0.0f) / kPi;
    }
  }

  /// Samples the layer for those `u` whose first coordinate lies in `range`.
  void sample_layer(const PreparedBrdf& point, size_t layer, const Vec2& range, std::span<const Vec2> u,
                    DirectionBatch& wl) const {
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
    layers_.reflecting[layer].material->sample(*point.layers[layer].point, {some, count}, drawn);
    for (size_t i = 0; i < count; ++i) wl.set(place[i], drawn.get(static_cast<int>(i)));
  }

  const ShaderLayers layers_;
  std::vector<float> albedo_;  // mean albedo of each reflecting layer; only steers sampling
};

}  // namespace

float LayerFactor::at(const SurfaceSite& site) const {
  const float given = texture.at(site, value);
  if (kind == Kind::gain) return std::max(given, 0.0f);
  const float share = std::clamp(given, 0.0f, 1.0f);
  return kind == Kind::rest ? 1 - share : share;
}

float LayerWeight::at(const SurfaceSite& site) const {
  float product = 1;
  for (const LayerFactor& f : factors) product *= f.at(site);
  return product;
}

bool LayerWeight::varies() const {
  return std::ranges::any_of(factors, [](const LayerFactor& f) { return f.texture.given(); });
}

std::shared_ptr<const Material> make_layered_material(ShaderLayers layers) {
  return std::make_shared<LayeredMaterial>(std::move(layers));
}

}  // namespace velour
