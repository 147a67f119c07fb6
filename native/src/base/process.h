// CPU time of a thread, memory of the process.
#pragma once

#include <time.h>
#include <cstdint>

namespace velour {

/// CPU time of the calling thread, in seconds from an arbitrary origin. Hardly affected by other programs.
inline double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Memory usage of the process.

/// Resident bytes of the whole process; 0 if the system does not report them.
uint64_t resident_bytes();

}  // namespace velour
