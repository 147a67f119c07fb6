#include "material/texture_slot.h"

#include "base/error.h"
#include "material/program/program.h"

namespace velour {

void MeshSets::use(const std::shared_ptr<const Program>& computing, uint32_t used) {
  if (program && program != computing) {
    refuse("A material cannot take values from two programs; use outputs of one program for all its parameters.");
  }
  program = computing;
  outputs |= used;
  uvs = std::max(uvs, static_cast<uint8_t>(computing->uv_sets()));
  colors = std::max(colors, static_cast<uint8_t>(computing->corner_sets()));
}

}  // namespace velour
