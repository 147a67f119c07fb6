#include "material/scattered_lobes.h"

#include <algorithm>

#include "job/error.h"
#include "sphere/frame.h"
#include "srbf/lobe_tree.h"

namespace velour {

namespace {

constexpr float kDefensiveShare = 0.05f;  // method 6.2

Vec3 mirror(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// wv as a view of the meridian phi = 0, and the azimuth by which the slices turn. At the pole the azimuth is 0.
struct Meridian {
  float sin_theta, cos_theta, sin_phi, cos_phi;

  explicit Meridian(const Vec3& w)
      : sin_theta(std::sqrt(w.x * w.x + w.y * w.y)),
        cos_theta(w.z),
        sin_phi(sin_theta > 0 ? w.y / sin_theta : 0),
        cos_phi(sin_theta > 0 ? w.x / sin_theta : 1) {}

  float theta() const { return std::atan2(sin_theta, cos_theta); }
  Vec3 view() const { return {sin_theta, 0, cos_theta}; }

  /// Turns a slice of a view of this meridian: about y, so that the view's mirror direction falls on ours, then by phi.
  Mat3 rotation_from(const Vec3& view, bool align) const {
    const float c = align ? cos_theta * view.z + sin_theta * view.x : 1;
    const float s = align ? sin_theta * view.z - cos_theta * view.x : 0;
    return {{cos_phi * c, sin_phi * c, s}, {-sin_phi, cos_phi, 0}, {-cos_phi * s, -sin_phi * s, c}};
  }
};

/// The lobes of a view as few Gaussians. An Abel-Poisson lobe, the Henyey-Greenstein density, counts as the Gaussian of
/// its mean cosine, which is its bandwidth.
ProposalLobes few_lobes(const ScatteredBrdf& brdf, size_t view) {
  GaussianLobes lobes;
  for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
    const auto own = static_cast<double>(brdf.bandwidth[j]);
    const double bandwidth = brdf.kernel == Kernel::gaussian ? own : gaussian_bandwidth_of_mean(1 - own);
    const double mass = static_cast<double>(luminance(brdf.coefficient[j])) * kernel_integral(brdf.kernel, own);
    lobes.add({brdf.center[j], static_cast<float>(bandwidth),
               static_cast<float>(mass / kernel_integral(Kernel::gaussian, bandwidth))});
  }
  ProposalLobes few;
  if (!brdf.diffuse.empty()) few.cosine = std::max(luminance(brdf.diffuse[view]), 0.0f);
  constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};
  for (const GaussianLobe& lobe : LobeTree(lobes).cut(kEverywhere, ProposalLobes::kCapacity)) {
    few.lobe[few.count++] = lobe;
  }
  return few;
}

int checked_neighbors(const ScatteredBrdf& brdf, int neighbors) {
  const int count = neighbors == 0 ? brdf.default_neighbors : neighbors;
  if (count < 1 || count > kMaxNeighbors) {
    throw Error(Status::invalid_argument, "neighbors is " + std::to_string(count) + "; choose 1 to " +
                                              std::to_string(kMaxNeighbors) + " neighbouring views");
  }
  if (count * brdf.max_lobes_per_view() > LobeMixture::kCapacity) {
    throw Error(Status::invalid_argument,
                std::to_string(count) + " neighbors of " + std::to_string(brdf.max_lobes_per_view()) +
                    " lobes a view exceed the " + std::to_string(LobeMixture::kCapacity) +
                    " lobes that can be mixed; choose fewer neighbors or fit with fewer lobes");
  }
  return count;
}

}  // namespace

ScatteredLobes::ScatteredLobes(const ScatteredBrdf& brdf, int neighbors)
    : kernel_(brdf.kernel),
      isotropic_(brdf.isotropic),
      align_views_(brdf.align_views),
      neighbors_(checked_neighbors(brdf, neighbors)),
      views_(brdf.views),
      search_(brdf.views, neighbors_),
      diffuse_(brdf.diffuse),
      first_lobe_(brdf.first_lobe),
      bandwidth_(brdf.bandwidth) {
  diffuse_.resize(views_.size(), Rgb(0));
  for (const Vec3& view : views_) theta_.push_back(Meridian(view).theta());
  for (size_t j = 0; j < brdf.center.size(); ++j) {
    x_.push_back(brdf.center[j].x);
    y_.push_back(brdf.center[j].y);
    z_.push_back(brdf.center[j].z);
    r_.push_back(brdf.coefficient[j].r);
    g_.push_back(brdf.coefficient[j].g);
    b_.push_back(brdf.coefficient[j].b);
    luminance_.push_back(std::max(luminance(brdf.coefficient[j]), 0.0f));
    mass_.push_back(luminance_.back() * static_cast<float>(kernel_integral(kernel_, bandwidth_[j])));
  }
  for (size_t view = 0; view < views_.size(); ++view) proposals_.push_back(few_lobes(brdf, view));
}

void ScatteredLobes::gather(const Vec3& wv, LobeMixture& mixture) const {
  mixture.clear(kernel_);
  const Placement placed = place(wv);
  for (int i = 0; i < placed.views.count; ++i) {
    add_slice(placed.views.index[i], placed.rotation[i], placed.views.weight[i], mixture);
  }
  mixture.finish(kDefensiveShare);
}

void ScatteredLobes::propose(const Vec3& wv, ProposalLobes& lobes) const {
  const Placement placed = place(wv);
  const ViewNeighbors& views = placed.views;
  const auto nearest = std::max_element(views.weight, views.weight + views.count) - views.weight;
  lobes = proposals_[static_cast<size_t>(views.index[nearest])];
  for (int j = 0; j < lobes.count; ++j) lobes.lobe[j].center = placed.rotation[nearest] * lobes.lobe[j].center;
}

ScatteredLobes::Placement ScatteredLobes::place(const Vec3& wv) const {
  return isotropic_ ? place_on_meridian(wv) : place_on_hemisphere(wv);
}

ScatteredLobes::Placement ScatteredLobes::place_on_meridian(const Vec3& wv) const {
  const Meridian meridian(wv);
  Placement placed;
  placed.views = neighbors_ == 2 ? bracketing_views(theta_, meridian.theta()) : search_.nearest(meridian.view());
  for (int i = 0; i < placed.views.count; ++i) {
    const Vec3& view = views_[static_cast<size_t>(placed.views.index[i])];
    placed.rotation[i] = meridian.rotation_from(view, align_views_);
  }
  return placed;
}

ScatteredLobes::Placement ScatteredLobes::place_on_hemisphere(const Vec3& wv) const {
  Placement placed;
  placed.views = search_.nearest(wv);
  for (int i = 0; i < placed.views.count; ++i) {
    const Vec3& view = views_[static_cast<size_t>(placed.views.index[i])];
    placed.rotation[i] = align_views_ ? rotation_between(mirror(view), mirror(wv)) : Mat3(1);
  }
  return placed;
}

void ScatteredLobes::add_slice(int view, const Mat3& rotation, float weight, LobeMixture& mixture) const {
  const auto at = static_cast<size_t>(view);
  const uint32_t first = first_lobe_[at];
  const auto from = [first](const std::vector<float>& values) { return values.data() + first; };
  const LobeSpan lobes{
      from(x_), from(y_), from(z_),         from(bandwidth_), from(r_),
      from(g_), from(b_), from(luminance_), from(mass_),      static_cast<int>(first_lobe_[at + 1] - first)};
  mixture.append(lobes, rotation, weight);
  mixture.add_diffuse(weight * diffuse_[at]);  // belongs to the normal: it does not turn with the highlight
}

}  // namespace velour
