#include "brdf/half_diff_table.h"

#include <algorithm>

#include "job/error.h"

namespace velour {
namespace {

double theta_h_node(const BrdfTableLayout& layout, int i) {
  return kPiD / 2 * std::pow(static_cast<double>(i) / layout.theta_h, layout.theta_h_power);
}
double theta_d_node(const BrdfTableLayout& layout, int k) { return kPiD / 2 * k / layout.theta_d; }
double phi_d_node(const BrdfTableLayout& layout, int l) { return kPiD * l / layout.phi_d; }

}  // namespace

DirectionPair BrdfTableLayout::pair(int i, int j, int k, int l) const {
  return pair_of_half_diff(theta_h_node(*this, i), 2 * kPiD / folds * j / phi_h, theta_d_node(*this, k),
                           phi_d_node(*this, l));
}

HorizonTest::HorizonTest(const BrdfTableLayout& layout) {
  for (int i = 0; i < layout.theta_h; ++i) {
    sin_h_.push_back(std::sin(theta_h_node(layout, i)));
    cos_h_.push_back(std::cos(theta_h_node(layout, i)));
  }
  for (int k = 0; k < layout.theta_d; ++k) {
    sin_d_.push_back(std::sin(theta_d_node(layout, k)));
    cos_d_.push_back(std::cos(theta_d_node(layout, k)));
  }
  for (int l = 0; l < layout.phi_d; ++l) cos_phi_.push_back(std::cos(phi_d_node(layout, l)));
}

HalfDiffTable::HalfDiffTable(const BrdfTableLayout& layout, std::vector<TableNode> nodes)
    : layout_(layout), nodes_(std::move(nodes)) {
  if (nodes_.size() != layout_.size())
    throw Error(Status::invalid_argument, "A BRDF table of " + std::to_string(layout_.size()) + " nodes cannot have " +
                                              std::to_string(nodes_.size()) + " values.");
}

HalfDiffTable::Step HalfDiffTable::clamped(float position, int count) {
  const int low = std::clamp(static_cast<int>(position), 0, count - 1);
  const int high = std::min(low + 1, count - 1);
  return {static_cast<size_t>(low), static_cast<size_t>(high), position - static_cast<float>(low)};
}

HalfDiffTable::Step HalfDiffTable::periodic(float position, int count) {
  const int floor = static_cast<int>(position);
  const int low = std::clamp(floor >= count ? floor - count : floor, 0, count - 1);
  const int high = low + 1 == count ? 0 : low + 1;
  return {static_cast<size_t>(low), static_cast<size_t>(high), position - static_cast<float>(floor)};
}

HalfDiffTable::Step HalfDiffTable::theta_h_step(float theta_h) const {
  const float share = theta_h * (2.0f / kPi);
  const float warped = layout_.theta_h_power == 2.0 ? std::sqrt(share)
                                                    : std::pow(share, static_cast<float>(1.0 / layout_.theta_h_power));
  Step step = clamped(warped * static_cast<float>(layout_.theta_h), layout_.theta_h);
  const size_t row =
      static_cast<size_t>(layout_.phi_h) * static_cast<size_t>(layout_.theta_d) * static_cast<size_t>(layout_.phi_d);
  return {step.low * row, step.high * row, step.weight};
}

void HalfDiffTable::add_plane(size_t base, const Step& theta_d, const Step& phi_d, float weight, float sum[4]) const {
  const TableNode* low = nodes_.data() + base + theta_d.low;
  const TableNode* high = nodes_.data() + base + theta_d.high;
  const float w_high = weight * theta_d.weight, w_low = weight - w_high;
  const float w01 = w_low * phi_d.weight, w00 = w_low - w01, w11 = w_high * phi_d.weight, w10 = w_high - w11;
  for (int c = 0; c < 4; ++c)
    sum[c] += w00 * low[phi_d.low].value[c] + w01 * low[phi_d.high].value[c] + w10 * high[phi_d.low].value[c] +
              w11 * high[phi_d.high].value[c];
}

bool HalfDiffTable::lookup(const Vec3& wl, const Vec3& wv, Rgb& f) const {
  const HalfDiff angle = half_diff(wl, wv);
  const Step theta_h = theta_h_step(angle.theta_h);
  Step theta_d = clamped(angle.theta_d * (2.0f / kPi) * static_cast<float>(layout_.theta_d), layout_.theta_d);
  theta_d.low *= static_cast<size_t>(layout_.phi_d);
  theta_d.high *= static_cast<size_t>(layout_.phi_d);
  const Step phi_d = periodic(angle.phi_d * (1.0f / kPi) * static_cast<float>(layout_.phi_d), layout_.phi_d);
  alignas(16) float sum[4] = {0, 0, 0, 0};
  if (layout_.phi_h == 1) {
    add_plane(theta_h.low, theta_d, phi_d, 1.0f - theta_h.weight, sum);
    add_plane(theta_h.high, theta_d, phi_d, theta_h.weight, sum);
  } else {
    const size_t plane = static_cast<size_t>(layout_.theta_d) * static_cast<size_t>(layout_.phi_d);
    const float turns = angle.phi_h * (0.5f / kPi) * static_cast<float>(layout_.folds);
    const Step phi_h = periodic((turns - std::floor(turns)) * static_cast<float>(layout_.phi_h), layout_.phi_h);
    for (const auto& [row, w] : {std::pair{theta_h.low, 1.0f - theta_h.weight}, {theta_h.high, theta_h.weight}}) {
      add_plane(row + phi_h.low * plane, theta_d, phi_d, w * (1.0f - phi_h.weight), sum);
      add_plane(row + phi_h.high * plane, theta_d, phi_d, w * phi_h.weight, sum);
    }
  }
  const bool covered = sum[3] > 0.0f;
  f = covered ? Rgb(sum[0], sum[1], sum[2]) / sum[3] : Rgb(0.0f);
  return covered;
}

}  // namespace velour
