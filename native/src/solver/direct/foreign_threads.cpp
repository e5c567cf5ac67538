#include "solver/direct/foreign_threads.h"

#include <mutex>

#ifndef _WIN32
#include <unistd.h>
#endif

#ifdef HOLOMORPH_WITH_OPENBLAS
extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads(void);
}
#endif

namespace holomorph::solver {

#ifdef HOLOMORPH_WITH_OPENBLAS

namespace {

std::mutex mutex;
int users = 0, before = 1;

}  // namespace

OneBlasThread::OneBlasThread() {
  const std::lock_guard lock(mutex);
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
