// The OpenMP threads of the libraries that factorise.
#pragma once

#include <future>

namespace holomorph::solver {

/// Whether this process was made by fork after the library was loaded.
bool is_forked();

/// Calls work(), on a thread of its own in a process made by fork. The calling thread may remember OpenMP threads of an
/// earlier factorisation, which only the parent has. It would wait for them for ever.
template <class Work>
auto on_sound_thread(const Work& work) {
  return is_forked() ? std::async(std::launch::async, work).get() : work();
}

}  // namespace holomorph::solver
