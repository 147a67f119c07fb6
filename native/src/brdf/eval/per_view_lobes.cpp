#include "brdf/eval/per_view_lobes.h"

#include <algorithm>
#include "base/error.h"
#include "material/material.h"
#include "math/sphere/frame.h"
#include "math/srbf/lobe_tree.h"

namespace velour {

namespace {

constexpr int kDissertationNeighbors = 4;

/// wv as a view on the meridian phi = 0, and the azimuth by which slices rotate. At the pole the azimuth is 0.
struct Meridian {
  float sin_theta, cos_theta, sin_phi, cos_phi;

  explicit Meridian(const Vec3& w)
      : sin_theta(std::sqrt(w.x * w.x + w.y * w.y)),
        cos_theta(w.z),
        sin_phi(sin_theta > 0 ? w.y / sin_theta : 0),
        cos_phi(sin_theta > 0 ? w.x / sin_theta : 1) {}

  float theta() const { return std::atan2(sin_theta, cos_theta); }
  Vec3 view() const { return {sin_theta, 0, cos_theta}; }

  /// Rotates a slice of `view` on the meridian: about y, to align its mirror direction with ours, then by phi.
  Mat3 rotation_from(const Vec3& view, bool align) const {
    const float c = align ? cos_theta * view.z + sin_theta * view.x : 1;
    const float s = align ? sin_theta * view.z - cos_theta * view.x : 0;
    return {{cos_phi * c, sin_phi * c, s}, {-sin_phi, cos_phi, 0}, {-cos_phi * s, -sin_phi * s, c}};
  }
};

/// The lobes of a view as Gaussians of luminance. An Abel-Poisson lobe (the Henyey-Greenstein density) becomes the
/// Gaussian of the same mean cosine, which is the lobe's bandwidth.
GaussianLobes gaussians_of(const PerViewBrdf& brdf, size_t view) {
  GaussianLobes lobes;
  for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
    const auto own = static_cast<double>(brdf.bandwidth[j]);
    const double bandwidth = brdf.kernel == Kernel::gaussian ? own : gaussian_bandwidth_of_mean(1 - own);
    const double mass = static_cast<double>(luminance(brdf.coefficient[j])) * kernel_integral(brdf.kernel, own);
    lobes.add({brdf.center[j], static_cast<float>(bandwidth),
               static_cast<float>(mass / kernel_integral(Kernel::gaussian, bandwidth))});
  }
  return lobes;
}

ProposalLobes proposal_of(const GaussianLobes& lobes, float cosine) {
  ProposalLobes few;
  few.cosine = cosine;
  constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};
  for (const GaussianLobe& lobe : LobeTree(lobes).cut(kEverywhere, ProposalLobes::kCapacity)) {
    few.lobe[few.count++] = lobe;
  }
  return few;
}

size_t nearest_of(const ViewNeighbors& views) {
  return static_cast<size_t>(std::max_element(views.weight, views.weight + views.count) - views.weight);
}

int checked_neighbors(const PerViewBrdf& brdf, int neighbors) {
  const int count = neighbors == 0 ? brdf.default_neighbors : neighbors;
  if (count < 1 || count > kMaxNeighbors) {
    throw Error(Status::invalid_argument, "The number of neighboring views (neighbors) is " + std::to_string(count) +
                                              "; it must be 1 to " + std::to_string(kMaxNeighbors) + ".");
  }
  if (count * brdf.max_lobes_per_view() > LobeMixture::kCapacity) {
    throw Error(Status::invalid_argument,
                std::to_string(count) + " neighboring views with " + std::to_string(brdf.max_lobes_per_view()) +
                    " lobes each exceed the limit of " + std::to_string(LobeMixture::kCapacity) +
                    " lobes. Use fewer neighbors, or fit with fewer lobes.");
  }
  return count;
}

int nearest_views(const PerViewBrdf& brdf, int neighbors) {
  if (neighbors != 0) return neighbors;
  return std::clamp(LobeMixture::kCapacity / std::max(brdf.max_lobes_per_view(), 1), 1, kDissertationNeighbors);
}

}  // namespace

PerViewLobes::PerViewLobes(const PerViewBrdf& brdf, int neighbors)
    : isotropic_(brdf.isotropic),
      align_views_(brdf.align_views),
      neighbors_(checked_neighbors(brdf, neighbors)),
      views_(brdf.views),
      search_(brdf.views, neighbors_),
      nearest_(brdf.views, nearest_views(brdf, neighbors)),
      lobes_(brdf.kernel) {
  for (size_t view = 0; view < views_.size(); ++view) add_view(brdf, view);
}

void PerViewLobes::add_view(const PerViewBrdf& brdf, size_t view) {
  const Rgb diffuse = brdf.diffuse.empty() ? Rgb(0) : brdf.diffuse[view];
  const float cosine = std::max(luminance(diffuse), 0.0f);
  theta_.push_back(Meridian(views_[view]).theta());
  for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
    lobes_.add(brdf.center[j], brdf.bandwidth[j], brdf.coefficient[j]);
  }
  lobes_.end_view(diffuse);
  proposals_.push_back(proposal_of(gaussians_of(brdf, view), cosine));
}

void PerViewLobes::gather(const Placement& placed, LobeMixture& mixture) const {
  const ViewNeighbors& views = placed.views;
  mixture.clear(lobes_.kernel());
  for (int i = 0; i < views.count; ++i) {
    lobes_.append_to(mixture, static_cast<size_t>(views.index[i]), placed.rotation[i], views.weight[i]);
  }
  mixture.finish(kDefensiveShare);
}

void PerViewLobes::propose(const Placement& placed, ProposalLobes& lobes) const {
  const size_t nearest = nearest_of(placed.views);
  lobes = proposals_[static_cast<size_t>(placed.views.index[nearest])];
  for (int j = 0; j < lobes.count; ++j) lobes.lobe[j].center = placed.rotation[nearest] * lobes.lobe[j].center;
}

PerViewLobes::Placement PerViewLobes::place(const Vec3& wv) const {
  if (!isotropic_) return turned(search_.nearest(wv), wv);
  const Meridian meridian(wv);
  return turned(neighbors_ == 2 ? bracketing_views(theta_, meridian.theta()) : search_.nearest(meridian.view()), wv);
}

PerViewLobes::Placement PerViewLobes::place_nearest(const Vec3& wv) const {
  return turned(nearest_.nearest(isotropic_ ? Meridian(wv).view() : wv), wv);
}

PerViewLobes::Placement PerViewLobes::turned(const ViewNeighbors& views, const Vec3& wv) const {
  const Meridian meridian(wv);
  Placement placed;
  placed.views = views;
  for (int i = 0; i < views.count; ++i) {
    const Vec3& view = views_[static_cast<size_t>(views.index[i])];
    if (isotropic_) {
      placed.rotation[i] = meridian.rotation_from(view, align_views_);
    } else {
      placed.rotation[i] = align_views_ ? rotation_between(reflected(view), reflected(wv)) : Mat3(1);
    }
  }
  return placed;
}

void ViewLobes::add(const Vec3& center, float bandwidth, const Rgb& coefficient) {
  x_.push_back(center.x);
  y_.push_back(center.y);
  z_.push_back(center.z);
  bandwidth_.push_back(bandwidth);
  r_.push_back(coefficient.r);
  g_.push_back(coefficient.g);
  b_.push_back(coefficient.b);
  luminance_.push_back(std::max(luminance(coefficient), 0.0f));
  mass_.push_back(luminance_.back() * static_cast<float>(kernel_integral(kernel_, static_cast<double>(bandwidth))));
}

void ViewLobes::end_view(const Rgb& diffuse) {
  first_.push_back(x_.size());
  diffuse_.push_back(diffuse);
}

void ViewLobes::append_to(LobeMixture& mixture, size_t view, const Mat3& rotation, float weight) const {
  const size_t first = first_[view];
  const auto from = [first](const std::vector<float>& values) { return values.data() + first; };
  const LobeSpan lobes{
      from(x_), from(y_), from(z_),         from(bandwidth_), from(r_),
      from(g_), from(b_), from(luminance_), from(mass_),      static_cast<int>(first_[view + 1] - first)};
  mixture.append(lobes, rotation, weight);
  mixture.add_diffuse(weight * diffuse_[view]);
}

}  // namespace velour
