#include "capture/goniometer/bins.h"

#include <algorithm>
#include <cmath>

namespace velour {

/// The two nodes around a coordinate and the share of the upper one.
struct PairGrid::Axis {
  int lower, upper;
  float share;

  /// Axis of nodes at `range` w(i / steps).
  static Axis warped(float x, float range, const std::vector<double>& nodes) {
    const int steps = static_cast<int>(nodes.size()) - 1;
    const float above = std::max(0.0f, 1.0f - x / range);  // its power 2/3 inverts w; the hats are linear in x itself
    const float u = 1.0f - std::cbrt(above * above);
    const int lower = std::clamp(static_cast<int>(static_cast<float>(steps) * u), 0, steps - 1);
    const auto begin = static_cast<float>(nodes[static_cast<size_t>(lower)]);
    const auto end = static_cast<float>(nodes[static_cast<size_t>(lower) + 1]);
    return {lower, lower + 1, std::clamp((x - begin) / (end - begin), 0.0f, 1.0f)};
  }
  /// Periodic axis of `steps` nodes at integer x.
  static Axis periodic(float x, int steps) {
    const float floor = std::floor(x);
    const int lower = ((static_cast<int>(floor) % steps) + steps) % steps;
    return {lower, (lower + 1) % steps, x - floor};
  }
  int node(int corner) const { return corner != 0 ? upper : lower; }
  float share_of(int corner) const { return corner != 0 ? share : 1.0f - share; }
};

namespace {

float polar_angle(const Vec3& w) { return std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }

std::vector<double> warped_nodes(double range, int steps) {
  std::vector<double> nodes;
  for (int i = 0; i <= steps; ++i) {
    nodes.push_back(range * (1.0 - std::pow(1.0 - static_cast<double>(i) / steps, 1.5)));
  }
  return nodes;
}

/// Integral of each hat.
std::vector<double> hat_integrals(const std::vector<double>& nodes) {
  std::vector<double> integrals(nodes.size(), 0.0);
  for (size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double half = 0.5 * (nodes[i + 1] - nodes[i]);
    integrals[i] += half;
    integrals[i + 1] += half;
  }
  return integrals;
}

/// Integral of each hat times cos(theta) sin(theta) d theta, by parts from the antiderivatives of cos sin.
std::vector<double> projected_integrals(const std::vector<double>& nodes) {
  const auto once = [](double theta) { return 0.5 * std::sin(theta) * std::sin(theta); };
  const auto twice = [](double theta) { return 0.25 * theta - 0.125 * std::sin(2.0 * theta); };
  std::vector<double> integrals(nodes.size(), 0.0);
  for (size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double mean = (twice(nodes[i + 1]) - twice(nodes[i])) / (nodes[i + 1] - nodes[i]);
    integrals[i] += mean - once(nodes[i]);
    integrals[i + 1] += once(nodes[i + 1]) - mean;
  }
  return integrals;
}

}  // namespace

PairGrid::PairGrid(int theta_steps, int phi_steps, int phi_v_steps)
    : theta_steps_(theta_steps),
      phi_steps_(phi_steps),
      phi_v_steps_(phi_v_steps),
      theta_(warped_nodes(0.5 * kPiD, theta_steps)),
      phi_(warped_nodes(kPiD, phi_steps)) {
  size_ = theta_.size() * theta_.size() * static_cast<size_t>(phi_nodes()) * static_cast<size_t>(phi_v_nodes());
}

size_t PairGrid::index_of(const Node& node) const {
  const int thetas = theta_steps_ + 1;
  return static_cast<size_t>(((node.theta_l * phi_nodes() + node.phi) * thetas + node.theta_v) * phi_v_nodes() +
                             node.phi_v);
}

PairGrid::Node PairGrid::node_at(size_t index) const {
  const int i = static_cast<int>(index), phis = phi_nodes(), thetas = theta_steps_ + 1, phis_v = phi_v_nodes();
  return {i / (phis_v * thetas * phis), i / (phis_v * thetas) % phis, i / phis_v % thetas, i % phis_v};
}

PairGrid::Axis PairGrid::phi_axis(const DirectionPair& pair) const {
  const Vec3 &l = pair.wl, &v = pair.wv;
  const float phi = std::atan2(v.x * l.y - v.y * l.x, v.x * l.x + v.y * l.y);
  Axis axis = Axis::warped(std::abs(phi), kPi, phi_);
  if (isotropic() || phi >= 0.0f) return axis;
  const int turn = 2 * phi_steps_;  // nodes of negative phi count down from here
  return {(turn - axis.lower) % turn, (turn - axis.upper) % turn, axis.share};
}

PairGrid::Stencil PairGrid::stencil(const DirectionPair& pair) const {
  const Axis theta_l = Axis::warped(polar_angle(pair.wl), 0.5f * kPi, theta_);
  const Axis theta_v = Axis::warped(polar_angle(pair.wv), 0.5f * kPi, theta_);
  const Axis phi = phi_axis(pair);
  Axis phi_v{0, 0, 0.0f};
  if (!isotropic()) {
    const float turns = std::atan2(pair.wv.y, pair.wv.x) / (2.0f * kPi);
    phi_v = Axis::periodic(turns * static_cast<float>(phi_v_steps_), phi_v_steps_);
  }
  Stencil stencil;
  stencil.count = isotropic() ? 8 : 16;
  for (int i = 0; i < stencil.count; ++i) {
    const int a = i & 1, b = (i >> 1) & 1, c = (i >> 2) & 1, d = (i >> 3) & 1;
    const auto at = static_cast<size_t>(i);
    const Node node{theta_l.node(a), phi.node(b), theta_v.node(c), phi_v.node(d)};
    stencil.node[at] = static_cast<uint32_t>(index_of(node));
    stencil.share[at] = theta_l.share_of(a) * phi.share_of(b) * theta_v.share_of(c) * phi_v.share_of(d);
  }
  return stencil;
}

std::vector<double> PairGrid::azimuth_measure() const {
  std::vector<double> measure = hat_integrals(phi_);
  if (isotropic()) {
    for (double& m : measure) m *= 2.0;  // both signs of phi
    return measure;
  }
  measure.front() *= 2.0;  // the hats of 0 and pi have a half on each side
  measure.back() *= 2.0;
  for (int i = phi_steps_ - 1; i > 0; --i) measure.push_back(measure[static_cast<size_t>(i)]);
  for (double& m : measure) m /= phi_v_steps_;  // uniform phi_v
  return measure;
}

std::vector<double> PairGrid::flux_measure(bool exchanged) const {
  std::vector<double> drawn = hat_integrals(theta_);
  for (double& d : drawn) d *= 2.0 / kPiD;  // the density of a uniform theta
  const std::vector<double> projected = projected_integrals(theta_), azimuth = azimuth_measure();
  std::vector<double> measure(size_);
  for (size_t i = 0; i < size_; ++i) {
    const Node node = node_at(i);
    const auto l = static_cast<size_t>(node.theta_l), v = static_cast<size_t>(node.theta_v);
    measure[i] =
        (exchanged ? drawn[l] * projected[v] : projected[l] * drawn[v]) * azimuth[static_cast<size_t>(node.phi)];
  }
  return measure;
}

template <class Map>
void PairGrid::add_image(std::span<double> sums, int channels, const Map& map) const {
  const std::vector<double> before(sums.begin(), sums.end());
  const auto n = static_cast<size_t>(channels);
  for (size_t i = 0; i < size_; ++i) {
    const size_t image = index_of(map(node_at(i)));
    for (size_t c = 0; c < n; ++c) sums[i * n + c] = before[i * n + c] + before[image * n + c];
  }
}

void PairGrid::pool_poles(std::span<double> sums, int channels) const {
  const std::vector<double> before(sums.begin(), sums.end());
  const auto n = static_cast<size_t>(channels);
  for (size_t i = 0; i < size_; ++i) {
    const Node node = node_at(i);
    if (node.theta_l != 0 && node.theta_v != 0) continue;
    for (size_t c = 0; c < n; ++c) {
      double total = 0;
      for (int phi = 0; phi < phi_nodes(); ++phi) {
        total += before[index_of({node.theta_l, phi, node.theta_v, node.phi_v}) * n + c];
      }
      sums[i * n + c] = total;
    }
  }
}

void PairGrid::pool_by_symmetry(std::span<double> sums, int channels) const {
  if (isotropic()) {
    pool_poles(sums, channels);
    return;
  }
  // Mirroring in y = 0 negates phi and phi_v; mirroring in x = 0 negates phi and turns phi_v into pi - phi_v.
  const int turn = 2 * phi_steps_, turn_v = phi_v_steps_;
  add_image(sums, channels, [turn, turn_v](const Node& n) {
    return Node{n.theta_l, (turn - n.phi) % turn, n.theta_v, (turn_v - n.phi_v) % turn_v};
  });
  add_image(sums, channels, [turn, turn_v](const Node& n) {
    return Node{n.theta_l, (turn - n.phi) % turn, n.theta_v, (turn_v + turn_v / 2 - n.phi_v) % turn_v};
  });
}

void PairGrid::pool_azimuths(std::span<double> sums) const {
  std::vector<double> total(theta_.size() * theta_.size(), 0.0);
  const auto cell = [this](size_t i) {
    const Node node = node_at(i);
    return static_cast<size_t>(node.theta_l) * theta_.size() + static_cast<size_t>(node.theta_v);
  };
  for (size_t i = 0; i < size_; ++i) total[cell(i)] += sums[i];
  for (size_t i = 0; i < size_; ++i) sums[i] = total[cell(i)];
}

namespace {

void add(std::vector<double>& to, const std::vector<double>& from, double sign) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += sign * from[i];
}

}  // namespace

GoniometerBins::GoniometerBins(const GoniometerOptions& options)
    : slopes(options.surface.roughness, options.surface.roughness / options.surface.anisotropy),
      mirror(options.surface.anisotropy == 1.0 ? PairGrid(24, 12, 0) : PairGrid(12, 9, 24)),
      metal(options.surface.anisotropy == 1.0 ? PairGrid(20, 24, 0) : PairGrid(12, 9, 24)),
      diffuse(options.body && options.body->has_flakes() ? metal
              : options.surface.anisotropy == 1.0        ? PairGrid(14, 9, 0)
                                                         : PairGrid(8, 6, 12)) {}

GoniometerSums::GoniometerSums(const GoniometerBins& bins)
    : metal_facets(bins.slopes.size()),
      tried(bins.mirror.size()),
      clear(bins.mirror.size()),
      metal_flux(3 * bins.metal.size()),
      diffuse_flux(3 * bins.diffuse.size()) {}

GoniometerSums& GoniometerSums::operator+=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, 1);
  add(tried, other.tried, 1);
  add(clear, other.clear, 1);
  add(metal_flux, other.metal_flux, 1);
  add(diffuse_flux, other.diffuse_flux, 1);
  facets += other.facets;
  samples += other.samples;
  rays += other.rays;
  lost += other.lost;
  return *this;
}

GoniometerSums& GoniometerSums::operator-=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, -1);
  add(tried, other.tried, -1);
  add(clear, other.clear, -1);
  add(metal_flux, other.metal_flux, -1);
  add(diffuse_flux, other.diffuse_flux, -1);
  facets -= other.facets;
  samples -= other.samples;
  rays -= other.rays;
  lost -= other.lost;
  return *this;
}

namespace {
constexpr int kPsiNodes = 5;  // every 22.5 degrees of the quarter turn
}

SlopeBins::SlopeBins(double alpha_x, double alpha_y)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), psis_(alpha_x == alpha_y ? 1 : kPsiNodes) {}

SlopeBins::Stencil SlopeBins::stencil(const Vec2& slope) const {
  const double x = std::abs(static_cast<double>(slope.x)) / alpha_x_;
  const double y = std::abs(static_cast<double>(slope.y)) / alpha_y_;
  const double r = kPerAlpha * std::sqrt(x * x + y * y);
  const int radius = static_cast<int>(std::min(r, 1e6));
  Stencil s{};
  s.inside = radius + 1 < radii();
  if (!s.inside) return s;
  const double psi = psis_ == 1 ? 0.0 : std::atan2(y, x) * (psis_ - 1) / (0.5 * kPiD);
  const int lower = std::clamp(static_cast<int>(psi), 0, std::max(psis_ - 2, 0));
  const int upper = std::min(lower + 1, psis_ - 1);
  const double in_r = r - radius, in_psi = psi - lower;
  const double share[4] = {(1 - in_r) * (1 - in_psi), (1 - in_r) * in_psi, in_r * (1 - in_psi), in_r * in_psi};
  for (int i = 0; i < 4; ++i) {
    s.node[i] = index(radius + i / 2, i % 2 == 0 ? lower : upper);
    s.share[i] = share[i];
  }
  return s;
}

void SlopeBins::deposit(const Vec2& slope, std::span<double> counts) const {
  const Stencil s = stencil(slope);
  if (!s.inside) return;
  for (int i = 0; i < 4; ++i) counts[s.node[i]] += s.share[i];
}

double SlopeBins::look_up(const Vec2& slope, std::span<const double> density) const {
  const Stencil s = stencil(slope);
  double value = 0;
  if (!s.inside) return value;
  for (int i = 0; i < 4; ++i) value += s.share[i] * density[s.node[i]];
  return value;
}

double SlopeBins::bin_area(int radius, int psi) const {
  // The hat of node k > 0 integrates r dr to k step^2, that of node 0 to step^2 / 6; psi folds four quarters into one.
  constexpr double step = 1.0 / kPerAlpha;
  const double ring = step * step * (radius == 0 ? 1.0 / 6.0 : radius);
  const bool end = psi == 0 || psi == psis_ - 1;
  const double turn = psis_ == 1 ? 1.0 : (end ? 0.5 : 1.0) / (psis_ - 1);
  return 2.0 * kPiD * turn * ring * alpha_x_ * alpha_y_;
}

std::vector<double> SlopeBins::density(std::span<const double> counts, double facets) const {
  std::vector<double> density(size());
  for (int radius = 0; radius < radii(); ++radius) {
    for (int psi = 0; psi < psis_; ++psi) {
      double count = 0, area = 0;
      for (int wide = 0; wide <= kMaxWidening; ++wide) {
        count = area = 0;
        for (int r = std::max(radius - wide, 0); r <= std::min(radius + wide, radii() - 1); ++r) {
          // A slope of zero has no azimuth: the innermost bin is shared by all psi.
          for (int p = r == 0 ? 0 : psi; p <= (r == 0 ? psis_ - 1 : psi); ++p) {
            count += counts[index(r, p)];
            area += bin_area(r, p);
          }
        }
        if (count >= kEnoughFacets) break;
      }
      density[index(radius, psi)] = count / (facets * area);
    }
  }
  return density;
}

}  // namespace velour
