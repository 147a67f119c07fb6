// CPU time.
#pragma once

#include <time.h>

namespace velour {

/// CPU time of the calling thread, in seconds from an arbitrary origin. Hardly affected by other programs.
inline double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace velour
