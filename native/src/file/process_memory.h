// Memory of the process.
#pragma once

#include <cstdint>

namespace velour {

/// Resident bytes of the whole process; 0 where the system does not tell.
uint64_t resident_bytes();

}  // namespace velour
