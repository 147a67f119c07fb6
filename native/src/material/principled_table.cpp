#include "material/principled_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

#include "job/parallel.h"

namespace velour {
namespace {

constexpr float kLast = PrincipledTable::kNodes - 1;

float roughness_at(float place) {
  const float root = place / kLast;
  return kMinRoughness + (1 - kMinRoughness) * root * root;
}

float place_of(float roughness) {
  const float square = (roughness - kMinRoughness) / (1 - kMinRoughness);
  return kLast * std::sqrt(std::clamp(square, 0.0f, 1.0f));
}

}  // namespace

PrincipledTable::PrincipledTable(const PrincipledParameters& parameters) : nodes_(kNodes) {
  const PrincipledLobes first(parameters);  // whose coat serves all
  const auto make = [&](size_t i) {
    PrincipledParameters p = parameters;
    p.roughness = roughness_at(static_cast<float>(i));
    nodes_[i] = first.with(p);
  };
  parallel_fill(nodes_.size(), make);
}

std::shared_ptr<const PrincipledTable> PrincipledTable::shared(const PrincipledParameters& p) {
  static std::mutex mutex;
  static std::map<std::array<float, 3>, std::weak_ptr<const PrincipledTable>> tables;
  const std::lock_guard lock(mutex);
  auto& kept = tables[{p.specular, p.coat, p.coat > 0 ? p.coat_roughness : 0.0f}];
  auto table = kept.lock();
  if (!table) kept = table = std::make_shared<const PrincipledTable>(p);
  return table;
}

void PrincipledTable::look_up(const PrincipledParameters& parameters, PrincipledLobes& lobes) const {
  const float place = place_of(parameters.roughness);
  const auto low = static_cast<size_t>(std::min(place, kLast - 1));
  lobes.blend(parameters, nodes_[low], nodes_[low + 1], place - static_cast<float>(low));
}

}  // namespace velour
