// SPDX-License-Identifier: GPL-3.0-or-later
// The memory and the processor time of a program that measures itself, on Linux.
#pragma once

#include <malloc.h>
#include <sys/resource.h>

#include <fstream>
#include <string>
#include <utility>

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

/// Seconds of the processors so far, of the user and of the system.
inline std::pair<double, double> spent() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime), seconds(usage.ru_stime)};
}

/// Lets what is freed from now on stay with the program, for its next run.
inline void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace holomorph::benchmarks
