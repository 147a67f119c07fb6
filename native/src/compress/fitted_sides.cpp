#include "compress/fitted_sides.h"

#include <cmath>
#include <optional>
#include <string>

#include "compress/equal_sides.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr double kUnlike = 0.1;  // relative difference of energies

/// Index of a side that equals this one.
std::optional<size_t> side_like(const BtfMeasurement& measurement, const std::vector<FittedSide>& sides,
                                const SideDirections& side, double energy, const Progress& progress) {
  for (size_t s = 0; s < sides.size(); ++s) {
    if (std::abs(energy - sides[s].energy) > kUnlike * energy) continue;  // without reading their images
    if (sides_are_equal(measurement, sides[s].directions, side, progress)) return s;
  }
  return std::nullopt;
}

}  // namespace

FittedSides fitted_sides(const BtfMeasurement& measurement, const ColourAxes& colours, const Progress& progress) {
  FittedSides found;
  for (SideDirections& side : sides_of(measurement.layout())) {
    const double energy = colours.energy_of(side.view_number, side.light_number);
    if (side.view_below != side.light_below && energy == 0) continue;
    if (const auto same = side_like(measurement, found.sides, side, energy, progress)) {
      found.sides[*same].energy += energy;
      found.shared.push_back({side.view_below, side.light_below, static_cast<uint32_t>(*same)});
      continue;
    }
    found.sides.push_back({std::move(side), energy});
  }
  return found;
}

void require_complete(const PairLayout& layout) {
  if (layout.complete()) return;
  throw Error(Status::unsupported,
              "The BTF has only " + std::to_string(layout.pairs()) +
                  " view-light pairs, but a model requires every view under every light. Use a BTF with all pairs.");
}

}  // namespace velour
