#include "compress/lobe_checkpoint.h"

#include <algorithm>

#include "btf/srbf_btf.h"
#include "compress/shared_lobes.h"

namespace velour {
namespace {

constexpr size_t kMaxCandidates = 3 * SrbfBtf::kMaxLobes;

std::string of_axis(const std::string& name, size_t axis) { return name + "." + std::to_string(axis); }

/// Whether sizes agree and residuals lie within [0, 1].
bool is_sound(const LobeOrder& order) {
  const auto share = order.share(order.axis.size());
  for (size_t a = 0; a < 3; ++a) {
    if (order.candidate[a].size() != share[a]) return false;
  }
  const auto outside = [](double left) { return left < 0 || left > 1; };
  return share[0] > 0 && order.left.size() == order.axis.size() &&
         std::none_of(order.left.begin(), order.left.end(), outside);
}

}  // namespace

std::optional<LobeOrder> kept_order(const FitCheckpoint& checkpoint, const std::string& stage) {
  LobeOrder order;
  const auto axis = checkpoint.wholes(stage + ".axis", kMaxCandidates, 2);
  const auto left = checkpoint.numbers(stage + ".left", kMaxCandidates);
  if (!axis || !left) return std::nullopt;
  for (const size_t a : *axis) order.axis.push_back(static_cast<uint8_t>(a));
  order.left = *left;
  for (size_t a = 0; a < 3; ++a) {
    // Nothing is stored for an axis without candidates.
    order.candidate[a] = checkpoint.wholes(of_axis(stage + ".candidate", a), kMaxCandidates, kLobeCandidates - 1)
                             .value_or(std::vector<size_t>());
  }
  return is_sound(order) ? std::optional(std::move(order)) : std::nullopt;
}

void keep_order(FitCheckpoint& checkpoint, const std::string& stage, const LobeOrder& order) {
  checkpoint.keep_wholes(stage + ".axis", {order.axis.begin(), order.axis.end()});
  checkpoint.keep_numbers(stage + ".left", order.left);
  for (size_t a = 0; a < 3; ++a) checkpoint.keep_wholes(of_axis(stage + ".candidate", a), order.candidate[a]);
  checkpoint.write();
}

bool take_kept_lobes(const FitCheckpoint& checkpoint, const std::string& stage, SharedLobes& lobes) {
  const size_t count = lobes.lobes.size();
  const auto vectors =
      checkpoint.matrix(stage + ".vectors", static_cast<Eigen::Index>(count), MultivariateLobe::kNumbers);
  if (!vectors) return false;
  for (size_t j = 0; j < count; ++j) {
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      lobes.lobes[j][k] = (*vectors)(static_cast<Eigen::Index>(j), k);
    }
  }
  for (size_t a = 1; a < 3; ++a) {
    const auto numbers = checkpoint.wholes(of_axis(stage + ".axis", a), count, count - 1);
    lobes.lobe[a].clear();
    for (const size_t n : numbers.value_or(std::vector<size_t>())) lobes.lobe[a].push_back(static_cast<uint16_t>(n));
  }
  return true;
}

void keep_lobes(FitCheckpoint& checkpoint, const std::string& stage, const SharedLobes& lobes) {
  RowMatrix vectors(static_cast<Eigen::Index>(lobes.lobes.size()), MultivariateLobe::kNumbers);
  for (size_t j = 0; j < lobes.lobes.size(); ++j) {
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      vectors(static_cast<Eigen::Index>(j), k) = lobes.lobes[j][k];
    }
  }
  checkpoint.keep(stage + ".vectors", vectors);
  for (size_t a = 1; a < 3; ++a) {
    checkpoint.keep_wholes(of_axis(stage + ".axis", a), {lobes.lobe[a].begin(), lobes.lobe[a].end()});
  }
  checkpoint.write();
}

}  // namespace velour
