// Processor time.
#pragma once

#include <time.h>

namespace velour {

/// Of the calling thread, since some fixed time: what other programs on the machine hardly change.
inline double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace velour
