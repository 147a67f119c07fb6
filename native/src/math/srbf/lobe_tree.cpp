#include "math/srbf/lobe_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/srbf/kernel.h"

namespace velour {
namespace {

/// Length lost by adding the moments of two nodes: energy times the growth of 1 - mean cosine.
double spread_by_joining(const Vec3d& a, const Vec3d& b) {
  return glm::length(a) + glm::length(b) - glm::length(a + b);
}

/// A Gaussian as mass times a density.
struct Weighted {
  double mass;
  Vec3d center;
  double bandwidth;
};

Weighted product(const GaussianLobe& a, const GaussianLobe& b) {
  const GaussianProduct p = gaussian_product(Vec3d(a.center), static_cast<double>(a.bandwidth), Vec3d(b.center),
                                             static_cast<double>(b.bandwidth));
  const double amplitude = static_cast<double>(a.amplitude) * static_cast<double>(b.amplitude) * p.scale;
  return {amplitude * kernel_integral(Kernel::gaussian, p.bandwidth), p.center, p.bandwidth};
}

/// Integral of the product of two weighted densities.
double inner(const Weighted& a, const Weighted& b) {
  const double integrals =
      kernel_integral(Kernel::gaussian, a.bandwidth) * kernel_integral(Kernel::gaussian, b.bandwidth);
  return a.mass * b.mass * kernel_convolution(Kernel::gaussian, a.center, a.bandwidth, b.center, b.bandwidth) /
         integrals;
}

}  // namespace

LobeTree::LobeTree(const GaussianLobes& lobes) {
  for (size_t k = 0; k < lobes.size(); ++k) {
    if (!(lobes.amplitude[k] > 0)) continue;
    const GaussianLobe lobe{{lobes.x[k], lobes.y[k], lobes.z[k]}, lobes.bandwidth[k], lobes.amplitude[k]};
    const auto bandwidth = static_cast<double>(lobe.bandwidth);
    const double energy = static_cast<double>(lobe.amplitude) * kernel_integral(Kernel::gaussian, bandwidth);
    nodes_.push_back({energy * (1 - gaussian_one_minus_mean(bandwidth)) * Vec3d(lobe.center), energy, lobe, {-1, -1}});
  }
  join_all();
}

LobeTree::Node LobeTree::joined(int first, int second) const {
  const Node &a = nodes_[static_cast<size_t>(first)], &b = nodes_[static_cast<size_t>(second)];
  Node node{a.sum + b.sum, a.energy + b.energy, {}, {first, second}};
  const double length = glm::length(node.sum);
  const double bandwidth = gaussian_bandwidth_of_mean(1 - length / node.energy);
  node.lobe = {length > 0 ? Vec3(node.sum / length) : a.lobe.center, static_cast<float>(bandwidth),
               static_cast<float>(node.energy / kernel_integral(Kernel::gaussian, bandwidth))};
  return node;
}

/// Each root stores its cheapest partner among the roots behind it. A join changes only two entries of the list, so few
/// of the others have to search again.
void LobeTree::join_all() {
  struct Root {
    int node;
    size_t partner;  // index of a later root
    double cost;
  };
  std::vector<Root> roots;
  const auto sum = [&](size_t place) -> const Vec3d& { return nodes_[static_cast<size_t>(roots[place].node)].sum; };
  const auto consider = [&](size_t place, size_t other) {
    const double cost = spread_by_joining(sum(place), sum(other));
    if (cost < roots[place].cost) roots[place] = {roots[place].node, other, cost};
  };
  const auto look = [&](size_t place) {
    roots[place].cost = std::numeric_limits<double>::infinity();
    for (size_t other = place + 1; other < roots.size(); ++other) consider(place, other);
  };
  for (size_t i = 0; i < nodes_.size(); ++i) roots.push_back({static_cast<int>(i), 0, 0});
  for (size_t i = 0; i < roots.size(); ++i) look(i);

  while (roots.size() > 1) {
    const auto cheapest =
        std::min_element(roots.begin(), roots.end(), [](const Root& a, const Root& b) { return a.cost < b.cost; });
    const auto kept = static_cast<size_t>(cheapest - roots.begin());
    const size_t freed = cheapest->partner, last = roots.size() - 1;
    nodes_.push_back(joined(roots[kept].node, roots[freed].node));
    roots[kept].node = static_cast<int>(nodes_.size()) - 1;
    roots[freed] = roots[last];
    roots.pop_back();
    for (size_t i = 0; i < roots.size(); ++i) {
      const size_t partner = roots[i].partner;
      if (i == kept || i == freed || partner == kept || partner == freed || partner == last) {
        look(i);
        continue;
      }
      if (kept > i) consider(i, kept);
      if (freed > i && freed < roots.size()) consider(i, freed);
    }
  }
}

/// Error of replacing the products of `lobe` with the children of `node` by that with `node`: their mass times the sine
/// of the angle between both as vectors of a function space, plus the difference of their masses.
double LobeTree::misfit(const Node& node, const GaussianLobe& lobe) const {
  if (node.child[0] < 0) return 0;
  const Weighted whole = product(lobe, node.lobe);
  const Weighted a = product(lobe, nodes_[static_cast<size_t>(node.child[0])].lobe);
  const Weighted b = product(lobe, nodes_[static_cast<size_t>(node.child[1])].lobe);
  const double children_sq = inner(a, a) + 2 * inner(a, b) + inner(b, b), whole_sq = inner(whole, whole);
  const double both = inner(whole, a) + inner(whole, b);
  const double sine_sq = children_sq > 0 && whole_sq > 0 ? 1 - both * both / (children_sq * whole_sq) : 1;
  const double mass = a.mass + b.mass;
  return mass * std::sqrt(std::max(sine_sq, 0.0)) + std::abs(mass - whole.mass);
}

std::vector<GaussianLobe> LobeTree::cut(const GaussianLobe& lobe, int most) const {
  if (empty()) return {};
  struct Candidate {
    int node;
    double misfit;
  };
  std::vector<uint8_t> opened(nodes_.size(), 0);
  std::vector<Candidate> front;
  const auto push = [&](int node) { front.push_back({node, misfit(nodes_[static_cast<size_t>(node)], lobe)}); };
  push(static_cast<int>(nodes_.size()) - 1);
  while (static_cast<int>(front.size()) < most) {
    const auto worst =
        std::max_element(front.begin(), front.end(), [](auto& a, auto& b) { return a.misfit < b.misfit; });
    if (!(worst->misfit > 0)) break;
    const auto node = static_cast<size_t>(worst->node);
    opened[node] = 1;
    *worst = front.back();
    front.pop_back();
    for (const int child : nodes_[node].child) push(child);
  }
  return in_order(opened);
}

std::vector<GaussianLobe> LobeTree::in_order(const std::vector<uint8_t>& opened) const {
  std::vector<GaussianLobe> lobes;
  std::vector<int> stack = {static_cast<int>(nodes_.size()) - 1};
  while (!stack.empty()) {
    const auto at = static_cast<size_t>(stack.back());
    stack.pop_back();
    if (opened[at]) {
      stack.insert(stack.end(), {nodes_[at].child[1], nodes_[at].child[0]});
    } else {
      lobes.push_back(nodes_[at].lobe);
    }
  }
  return lobes;
}

}  // namespace velour
