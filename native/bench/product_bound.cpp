// How much product sampling can gain, and how much of that it does: variances by quadrature, free of noise.
//
//   product_bound --mesh M.obj --material M.velour --world W.hdr [--size 640x480] [--hits 200] [--seed 1] [--share S]
//
// At points that random camera rays meet, x = f L cos V is tabulated on the texels of a 1024 x 512 picture of the
// environment, with every density. Variance of one direction, as of one of many whose shares c_k come from p_k:
//   int x^2 / d - sum_k c_k (int p_k x / d)^2,  d = sum_k c_k p_k
// and of the exact product, d ~ luminance(f L cos), the best that knows no shadow. Each by channel over I^2 + 0.01 of
// its mean square over the hits, then averaged (the picture's relmse, without what camera rays differ by).
// "unshadowed": the same with V = 1. Prints one JSON object.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "light/environment_mixture.h"
#include "material/material.h"
#include "math/sphere/random.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "render/lights/environment_proposals.h"
#include "render/lights/lighting.h"
#include "render/path/direction_sampling.h"
#include "render/path/vertex.h"
#include "scene/mesh_file.h"
#include "scene/scene.h"

namespace {

using namespace velour;

/// Pairs of words: --name value.
class Arguments {
 public:
  /// `values`: those that need not be given.
  Arguments(int argc, char** argv, std::map<std::string, std::string> values) : values_(std::move(values)) {
    for (int i = 1; i + 1 < argc; i += 2) values_[std::string(argv[i]).substr(2)] = argv[i + 1];
  }
  /// Throws where it was not given and has no default.
  const std::string& operator[](const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) throw std::runtime_error("product_bound: --" + name + " is missing.");
    return found->second;
  }
  int width() const { return std::stoi((*this)["size"]); }
  int height() const {
    const std::string& size = (*this)["size"];
    return std::stoi(size.substr(size.find('x') + 1));
  }

 private:
  std::map<std::string, std::string> values_;
};

/// The scene of `velour render` with its defaults: --mesh, whose y is up; --material, a model; --world; the camera that
/// frames the mesh in a picture of --size. Committed.
void describe(const Arguments& a, Scene& scene) {
  const Affine up{{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0}};
  const uint32_t mesh = scene.add_mesh(read_obj(a["mesh"]));
  const auto material = make_material(std::make_shared<const Model>(load_model(a["material"])), 0);
  scene.add_instance(mesh, up, {scene.add_material({.material = material})});
  scene.set_environment(Environment::load(a["world"], {}, 1, Mat3(1)));
  scene.frame_camera(static_cast<float>(a.width()) / static_cast<float>(a.height()), 2);
  scene.commit();
}

constexpr int kColumns = 1024, kRows = 512;
enum Density { kProduct, kSurface, kLights, kExact, kDensities };
enum Case { kMis, kProductCase, kExactCase, kCases };
constexpr const char* kNames[kCases] = {"mis", "product", "exact"};

/// What a vertex sees at one texel.
struct Place {
  double weight = 0;  // solid angle
  Vec3d x{0};         // f L cos
  bool visible = false;
  double pdf[kDensities] = {};  // kExact is not normalized
};

/// Texels above both horizons of a vertex, a batch at a time.
class Tabulation {
 public:
  Tabulation(const Scene& scene, const Lighting& lighting, const Vertex& vertex, const PreparedBrdf& prepared,
             const LobeMixture* product)
      : scene_(scene), lighting_(lighting), vertex_(vertex), prepared_(prepared), product_(product) {
    for (int y = 0; y < kRows; ++y) add_row(y);
    flush();
  }
  std::vector<Place> take() { return std::move(places_); }

 private:
  void add_row(int y) {
    const double theta = kPiD * (y + 0.5) / kRows;
    const double area = 4 * kPiD / kColumns * std::sin(theta) * std::sin(kPiD / (2 * kRows));
    for (int x = 0; x < kColumns; ++x) {
      const double phi = 2 * kPiD * (0.5 - (x + 0.5) / kColumns);
      const Vec3 w = direction(static_cast<float>(theta), static_cast<float>(phi));
      const Vec3 wl = vertex_.frame.to_local(w);
      if (!(wl.z > 0.0f) || !(glm::dot(w, vertex_.geometric_normal) > 0.0f)) continue;
      world_.push(w);
      local_.push(wl);
      rays_.push_back(vertex_.ray(w, std::numeric_limits<float>::infinity()));
      places_.emplace_back().weight = area;
      if (world_.count == DirectionBatch::kCapacity) flush();
    }
  }

  void flush() {
    if (world_.count == 0) return;
    world_.pad();
    local_.pad();
    RgbBatch f, radiance;
    ScalarBatch surface, lights, product{};
    std::vector<LampHit> none;
    const std::vector<Vec3> position(static_cast<size_t>(world_.count), vertex_.position);
    uint8_t blocked[DirectionBatch::kCapacity];
    prepared_.eval(local_, f, surface);
    lighting_.environment().look_up(world_, radiance, lights);
    if (product_ != nullptr) eval_density(*product_, world_, product);
    scene_.rays().occluded(rays_, blocked);
    for (int i = 0; i < world_.count; ++i) {
      Place& place = places_[places_.size() - static_cast<size_t>(world_.count - i)];
      const Rgb x = f.get(i) * radiance.get(i) * local_.z[i];
      place.x = Vec3d(x);
      place.visible = blocked[i] == 0;
      const float pdf[kDensities] = {product.v[i], surface.v[i], lights.v[i], luminance(x)};
      std::copy(pdf, pdf + kDensities, place.pdf);
    }
    world_.count = local_.count = 0;
    rays_.clear();
  }

  const Scene& scene_;
  const Lighting& lighting_;
  const Vertex& vertex_;
  const PreparedBrdf& prepared_;
  const LobeMixture* product_;
  DirectionBatch world_, local_;
  std::vector<Ray> rays_;
  std::vector<Place> places_;
};

struct Moments {
  Vec3d integral{0}, variance{0};
};

Moments moments(const std::vector<Place>& places, const double (&share)[kDensities], bool shadowed) {
  Vec3d integral(0), second(0), mean[kDensities] = {};
  for (const Place& p : places) {
    if (shadowed && !p.visible) continue;
    double d = 0;
    for (int k = 0; k < kDensities; ++k) d += share[k] * p.pdf[k];
    if (!(d > 0)) continue;
    integral += p.weight * p.x;
    second += p.weight / d * p.x * p.x;
    for (int k = 0; k < kDensities; ++k) mean[k] += p.weight * p.pdf[k] / d * p.x;
  }
  for (int k = 0; k < kDensities; ++k) second -= share[k] * mean[k] * mean[k];
  return {integral, second};
}

EnvironmentProposals proposals(const Environment& environment, const Progress& progress) {
  const EnvironmentMixture sky = mixture_of_environment(environment, {}, "", progress);
  return EnvironmentProposals(sky, misfit_of_environment(environment, sky));
}

class Study {
 public:
  explicit Study(const Arguments& a)
      : product_share_(std::stod(a["share"])),
        lighting_(prepare(a)),
        random_(std::stoull(a["seed"]), 0, 0),
        sky_(proposals(scene_.environment(), progress_)),
        lights_part_(lights_parts(scene_, sky_)) {
    for (size_t hits = std::stoul(a["hits"]); hits_.size() < hits;) visit();
  }

  nlohmann::json report() const {
    nlohmann::json j{{"hits", hits_.size()}, {"lobes", lobes_ / static_cast<double>(hits_.size())}};
    for (const bool shadowed : {true, false}) {
      for (int c = 0; c < kCases; ++c) j[shadowed ? "variance" : "unshadowed"][kNames[c]] = relative(shadowed, c);
    }
    return j;
  }

 private:
  using Hits = std::array<std::array<Moments, kCases>, 2>;

  Lighting prepare(const Arguments& a) {
    describe(a, scene_);
    return Lighting(scene_, Progress());
  }

  void visit() {
    Hit hit;
    const Ray ray = scene_.camera().ray(random_.next2());
    scene_.rays().intersect(ray, hit);
    if (hit.instance == kNoHit) return;
    const SurfacePoint point = scene_.surface(hit);
    Vertex vertex(point, -ray.direction);
    vertex.surface = &scene_.materials()[point.material];
    const Material& material = *vertex.surface->material;
    arena_.reset();
    const PreparedBrdf* const prepared = material.prepare(vertex.wv, arena_);
    ProposalLobes lobes;
    const bool proposed = prepared->proposal_lobes(lobes) && sky_.propose(lobes, vertex.frame, scratch_, product_);
    if (proposed) lobes_ += product_.count;
    const double both = proposed ? product_share_ : 0;
    const double lights = static_cast<double>(lights_part_[point.material]) * both;
    add(Tabulation(scene_, lighting_, vertex, *prepared, proposed ? &product_ : nullptr).take(), both - lights, lights);
  }

  void add(const std::vector<Place>& places, double product, double instead) {
    double exact = 0;
    for (const Place& place : places) exact += place.weight * place.pdf[kExact];
    if (!(exact > 0)) return;  // unlit
    const double rest = 0.5 * (1 - product - instead);
    const double shares[kCases][kDensities] = {{0, 0.5, 0.5, 0}, {product, rest, rest + instead, 0}, {0, 0, 0, 1}};
    std::vector<Place> normalized = places;
    for (Place& place : normalized) place.pdf[kExact] /= exact;
    Hits& of = hits_.emplace_back();
    for (const bool shadowed : {true, false}) {
      for (int c = 0; c < kCases; ++c) of[shadowed][static_cast<size_t>(c)] = moments(normalized, shares[c], shadowed);
    }
  }

  double relative(bool shadowed, int which) const {
    const auto c = static_cast<size_t>(which);
    Vec3d mean_square(0);
    for (const Hits& h : hits_) mean_square += h[shadowed][c].integral * h[shadowed][c].integral;
    mean_square /= static_cast<double>(hits_.size());
    Vec3d sum(0);
    for (const Hits& h : hits_) {
      sum += h[shadowed][c].variance / (h[shadowed][c].integral * h[shadowed][c].integral + 0.01 * mean_square);
    }
    return (sum.x + sum.y + sum.z) / 3 / static_cast<double>(hits_.size());
  }

  const double product_share_;
  Progress progress_;
  Scene scene_;
  const Lighting lighting_;
  RandomStream random_;
  const EnvironmentProposals sky_;
  const std::vector<float> lights_part_;
  ScratchArena arena_;
  LobeProducts scratch_;
  LobeMixture product_;
  double lobes_ = 0;
  std::vector<Hits> hits_;
};

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments(
      argc, argv, {{"size", "640x480"}, {"hits", "200"}, {"seed", "1"}, {"share", std::to_string(kProductShare)}});
  std::printf("%s\n", Study(arguments).report().dump(2).c_str());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
