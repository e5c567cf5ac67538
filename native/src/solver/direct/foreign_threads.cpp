#include "solver/direct/foreign_threads.h"

#ifndef _WIN32
#include <unistd.h>
#endif

namespace holomorph::solver {

#ifndef _WIN32

namespace {

const pid_t kLoadedIn = getpid();

}  // namespace

bool is_forked() { return getpid() != kLoadedIn; }

#else

bool is_forked() { return false; }

#endif

}  // namespace holomorph::solver
