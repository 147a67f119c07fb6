#include "brdf/eval/per_view_lobes.h"

#include <algorithm>

#include "base/error.h"
#include "material/material.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/warp.h"
#include "math/srbf/lobe_tree.h"

namespace velour {

namespace {

/// Angle between unit directions, from the chord, which keeps small angles that a dot product would lose.
float angle_between(const Vec3& a, const Vec3& b) { return 2 * std::asin(std::min(0.5f * glm::distance(a, b), 1.0f)); }

/// The floor is below the rounding of a float direction and represents an exact hit.
float inverse_angle(const Vec3& a, const Vec3& b) {
  constexpr float kHit = 1e-8f;
  return 1 / std::max(angle_between(a, b), kHit);
}

/// Drops negligible weights, which makes a hit exact and saves its neighbors' lobes, and scales the sum to 1.
void normalize(ViewNeighbors& set) {
  constexpr float kNegligible = 1e-5f;
  float total = 0;
  for (int i = 0; i < set.count; ++i) total += set.weight[i];
  if (total <= 0) {  // all candidates are equally far
    std::fill_n(set.weight, set.count, 1.0f);
    total = static_cast<float>(set.count);
  }
  int kept = 0;
  float kept_total = 0;
  for (int i = 0; i < set.count; ++i) {
    if (set.weight[i] <= kNegligible * total) continue;
    set.index[kept] = set.index[i];
    kept_total += set.weight[kept] = set.weight[i];
    ++kept;
  }
  for (int i = 0; i < kept; ++i) set.weight[i] /= kept_total;
  set.count = kept;
}

}  // namespace

ViewNeighbors bracketing_views(std::span<const float> theta, float theta_v) {
  ViewNeighbors set;
  if (theta.empty()) return set;
  const int last = static_cast<int>(theta.size()) - 1;
  const auto above = static_cast<int>(std::upper_bound(theta.begin(), theta.end(), theta_v) - theta.begin());
  if (above == 0 || above > last) {
    set.count = 1;
    set.index[0] = std::min(above, last);
    set.weight[0] = 1;
    return set;
  }
  const float low = theta[static_cast<size_t>(above - 1)], high = theta[static_cast<size_t>(above)];
  const float share = (theta_v - low) / (high - low);  // high > theta_v >= low
  set.count = 2;
  set.index[0] = above - 1;
  set.index[1] = above;
  set.weight[0] = 1 - share;
  set.weight[1] = share;
  normalize(set);
  return set;
}

ViewSearch::ViewSearch(std::span<const Vec3> views, int k) : views_(views.begin(), views.end()), k_(k), first_{0} {
  for (int cell = 0; cell < kSide * kSide; ++cell) fill_cell(cell);
}

/// Let r be the cell's radius about its center c, and v the last of the k + 1 views nearest to c. From any direction in
/// the cell, k + 1 views are within angle(c, v) + r, so the k + 1 nearest are as well, and these are within angle(c, v)
/// + 2 r of c. A cell is a convex polygon, or two that share its corners, so its farthest points are corners.
void ViewSearch::fill_cell(int cell) {
  constexpr float kRounding = 1e-3f;
  const Vec3 center = octahedral_cell_center(cell, kSide);
  const Vec2 low(static_cast<float>(cell % kSide), static_cast<float>(cell / kSide));
  float radius = 0;
  for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
    radius = std::max(radius, angle_between(octahedral_to((low + corner) / static_cast<float>(kSide)), center));
  }
  int found[kMaxNeighbors + 1];
  const int count = nearest_directions(views_, center, k_ + 1, found);
  const float last = count > 0 ? angle_between(views_[static_cast<size_t>(found[count - 1])], center) : 0;
  for (uint32_t i = 0; i < views_.size(); ++i) {
    if (angle_between(views_[i], center) <= last + 2 * radius + kRounding) candidates_.push_back(i);
  }
  first_.push_back(static_cast<uint32_t>(candidates_.size()));
}

ViewNeighbors ViewSearch::nearest(const Vec3& wv) const {
  const auto cell = static_cast<size_t>(octahedral_cell(wv, kSide));
  const auto among = std::span(candidates_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  int found[kMaxNeighbors + 1];
  const int count = nearest_directions(views_, among, wv, k_ + 1, found);
  const auto inverse = [&](int i) { return inverse_angle(views_[static_cast<size_t>(found[i])], wv); };
  const float cutoff = count > k_ ? inverse(k_) : 0;
  ViewNeighbors set;
  set.count = std::min(count, k_);
  for (int i = 0; i < set.count; ++i) {
    set.index[i] = found[i];
    set.weight[i] = std::max(inverse(i) - cutoff, 0.0f);
  }
  if (set.count > 0) normalize(set);
  return set;
}

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
