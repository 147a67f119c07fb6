// Memory usage of the process.
#pragma once

#include <cstdint>

namespace velour {

/// Resident bytes of the whole process; 0 if the system does not report them.
uint64_t resident_bytes();

}  // namespace velour
