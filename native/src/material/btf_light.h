// Where the light of a BTF's material comes from.
#pragma once

namespace velour {

/// Materials of BTFs give f of light from one side of the surface; of the other side they know its directions mirrored.
enum class BtfLight { viewers_side, other_side };

}  // namespace velour
