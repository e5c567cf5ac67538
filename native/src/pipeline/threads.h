// The number of worker threads of one computation.
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

namespace holomorph::pipeline {

/// Sets the calling thread's number of workers and puts it back at the end; 0 leaves it.
class ThreadCount {
 public:
#ifdef _OPENMP
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) {
    if (threads > 0) omp_set_num_threads(threads);
  }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
#else
  explicit ThreadCount(int) {}
#endif
};

}  // namespace holomorph::pipeline
