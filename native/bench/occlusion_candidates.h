// Ways to keep the view-dependent occlusion V(t, wv) of texels, to be compared.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/sphere/direction_mesh.h"
#include "votf/eval/visibility_mask.h"

namespace velour {

/// Numbers of texels under the stored views, positive where the view finds the texel covered, [texel][view].
struct LevelTable {
  std::vector<Vec3> views;
  std::vector<float> level;

  size_t texels() const { return level.size() / views.size(); }
};

struct OcclusionQuery {
  size_t texel;
  Vec3 wv;
};

class OcclusionCandidate {
 public:
  virtual ~OcclusionCandidate() = default;
  virtual bool covered(size_t texel, uint32_t view) const = 0;
  virtual bool covered(size_t texel, const Vec3& wv) const = 0;
  /// The same of many, for those that are faster together.
  virtual void covered(std::span<const OcclusionQuery> queries, uint8_t* found) const {
    for (size_t i = 0; i < queries.size(); ++i) found[i] = covered(queries[i].texel, queries[i].wv) ? 1 : 0;
  }

  std::string name;
  std::vector<uint8_t> stored;  // all that it would keep in a file
  double seconds = 0;           // to make it, of processor time
};

/// The table itself, 1 bit (`bits`) or 1 byte a number; between the views linear.
std::unique_ptr<OcclusionCandidate> whole_table(const LevelTable& table, bool bits);

/// Texels as slices of a clustered tensor, thresholded; everything in bytes. K-CTA where members > 1.
struct ClusteredShape {
  int clusters, members, rank;
};
std::unique_ptr<OcclusionCandidate> clustered(const LevelTable& table, const ClusteredShape& shape, uint64_t seed);

/// A constant and a few SRBFs of wv a texel, thresholded; a byte a number.
std::unique_ptr<OcclusionCandidate> texel_lobes(const LevelTable& table, int lobes);

/// The shell's distances, on a grid as fine as the texels or another.
std::unique_ptr<OcclusionCandidate> shell_distances(std::shared_ptr<const VotfVolume> volume, const TileTexels& texels,
                                                    const std::vector<Vec3>& views);

}  // namespace velour
