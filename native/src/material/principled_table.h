// Principled lobes of any roughness, quickly.
#pragma once

#include <memory>
#include <vector>

#include "material/principled_lobes.h"

namespace velour {

/// Albedos at kNodes roughnesses, closer where they are low, linear in its square root between them: a hit of a
/// textured material gets its lobes without an integral. The mean of an albedo is linear in it, so what the interpolant
/// reflects and what it lets through still make up for each other, and a white base keeps all light but for the
/// interpolant's error: below 0.001 at roughnesses from 0.1, 0.002 below. Immutable, thread-safe.
class PrincipledTable {
 public:
  /// For materials that share specular and coat with `parameters`. Takes a tenth of a second of one core.
  explicit PrincipledTable(const PrincipledParameters& parameters);
  /// The same; materials that need one table at a time share it.
  static std::shared_ptr<const PrincipledTable> shared(const PrincipledParameters& parameters);

  /// Sets `lobes` to those of `parameters`. No allocation.
  void look_up(const PrincipledParameters& parameters, PrincipledLobes& lobes) const;

  static constexpr int kNodes = 40;

 private:
  std::vector<PrincipledLobes> nodes_;
};

}  // namespace velour
