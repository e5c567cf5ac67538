// SPDX-License-Identifier: GPL-3.0-or-later
// The memory of a program that measures itself, on Linux.
#pragma once

#include <malloc.h>

#include <fstream>
#include <string>

namespace holomorph::benchmarks {

/// The most bytes that were resident at once, of this program alone: getrusage counts what its parent had before it as
/// well.
inline double peak_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0;
  while (word != "VmHWM:" && status >> word) {
  }
  status >> kilobytes;
  return 1024 * kilobytes;
}

/// Lets what is freed from now on stay with the program, for its next run.
inline void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace holomorph::benchmarks
