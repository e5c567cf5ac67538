#include "solver/direct/foreign_threads.h"

#include <cstdlib>
#include <mutex>
#include <new>

#ifndef _WIN32
#include <unistd.h>
#endif

#ifdef HOLOMORPH_WITH_OPENBLAS
extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads(void);
void dpotrf_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
}
#endif

namespace holomorph::solver {

#ifdef HOLOMORPH_WITH_OPENBLAS

namespace {

// OpenBLAS's workspace of a call, in bytes: 128 MiB and what malloc adds. It is kept for later calls.
constexpr std::size_t kWorkspace = std::size_t{130} << 20;
// What malloc of two other threads may take between the question and the call: 128 MiB each for an arena of their own.
constexpr std::size_t kArenas = std::size_t{256} << 20;

std::mutex mutex;
int users = 0, workspaces = 0, before = 1;

// OpenBLAS asks for its workspace again and again, without end, where there is no memory: so it is asked for here
// first. The first one is then taken at once, before anything else takes the memory.
// @throws std::bad_alloc
void take_workspace() {
  void* const found = std::malloc(kWorkspace + kArenas);
  if (found == nullptr) throw std::bad_alloc();
  std::free(found);
  if (workspaces++ > 0) return;
  const int n = 1;
  int info = 0;
  double one = 1;
  dpotrf_("L", &n, &one, &n, &info);
}

}  // namespace

OneBlasThread::OneBlasThread() {
  const std::lock_guard lock(mutex);
  if (users == workspaces) take_workspace();
  if (users++ > 0) return;
  before = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

OneBlasThread::~OneBlasThread() {
  const std::lock_guard lock(mutex);
  if (--users == 0) openblas_set_num_threads(before);
}

#else

OneBlasThread::OneBlasThread() {}
OneBlasThread::~OneBlasThread() {}

#endif

#ifndef _WIN32

namespace {

const pid_t kLoadedIn = getpid();

}  // namespace

bool is_forked() { return getpid() != kLoadedIn; }

#else

bool is_forked() { return false; }

#endif

}  // namespace holomorph::solver
