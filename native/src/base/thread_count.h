// How many threads a computation has.
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

namespace holomorph {

/// What the caller asked for, or as many as there are processors: OpenMP's number for the calling thread.
inline int thread_count() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

}  // namespace holomorph
