// Which side of the surface a BTF material is lit from.
#pragma once

namespace velour {

/// f is given for light from one side of the surface. For other_side, light directions are mirrored (z > 0).
enum class BtfLight { viewers_side, other_side };

}  // namespace velour
