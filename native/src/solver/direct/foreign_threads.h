// The threads of the libraries that factorise: BLAS's and OpenMP's.
#pragma once

#include <future>

namespace holomorph::solver {

/// While an instance is alive, BLAS runs on one thread, so that the bits do not depend on the number of threads. That
/// number belongs to the process: the destructor of the last instance restores it.
class OneBlasThread {
 public:
  /// @throws std::bad_alloc where BLAS would wait for memory for ever
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

/// Whether this process was made by fork after the library was loaded.
bool is_forked();

/// Calls work(), on a thread of its own in a process made by fork. The calling thread may remember OpenMP threads of an
/// earlier factorisation, which only the parent has. It would wait for them for ever.
template <class Work>
auto on_sound_thread(const Work& work) {
  return is_forked() ? std::async(std::launch::async, work).get() : work();
}

}  // namespace holomorph::solver
