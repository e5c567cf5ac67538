// Loops over rows that give the same bits at any number of threads. Chunks are fixed, and each row is written by one
// thread. Sums are taken per chunk, then in the order of the chunks. Which thread does a chunk changes nothing.
#pragma once

#include <algorithm>
#include <exception>
#include <type_traits>

#include "base/workers.h"

namespace holomorph {

/// Rows of a chunk: enough work to be worth handing out, few enough to share out the rows of a coarse level.
inline constexpr int kChunk = 4096;

inline int chunk_count(int rows) { return (rows + kChunk - 1) / kChunk; }

/// Calls task(chunk), or task(thread, chunk), for each of `chunks` chunks, in parallel. The task may throw: when all
/// are done, the exception of the lowest chunk is thrown again.
template <class Task>
void run_throwing(Workers& workers, int chunks, const Task& task, int too_few = Workers::kTooFew) {
  std::vector<std::exception_ptr> failures(chunks);
  workers.run(
      chunks,
      [&](int thread, int chunk) {
        try {
          if constexpr (std::is_invocable_v<Task, int, int>) {
            task(thread, chunk);
          } else {
            task(chunk);
          }
        } catch (...) {
          failures[chunk] = std::current_exception();
        }
      },
      too_few);
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

/// The same for few tasks that are long: each of them is worth a thread.
template <class Task>
void run_long_tasks(Workers& workers, int count, const Task& task) {
  run_throwing(workers, count, task, 1);
}

/// body(row) for every row, in parallel. @pre body does not throw
template <class Body>
void for_rows(Workers& workers, int rows, const Body& body) {
  workers.run(chunk_count(rows), [&](int, int chunk) {
    for (int i = chunk * kChunk, end = std::min(i + kChunk, rows); i < end; ++i) body(i);
  });
}

/// The lowest row for which test(row) holds, in parallel; `rows` where there is none.
template <class Test>
int first_row(Workers& workers, int rows, const Test& test) {
  std::vector<int> first(chunk_count(rows), rows);
  run_throwing(workers, chunk_count(rows), [&](int chunk) {
    for (int i = chunk * kChunk, end = std::min(i + kChunk, rows); i < end && first[chunk] == rows; ++i) {
      if (test(i)) first[chunk] = i;
    }
  });
  return first.empty() ? rows : *std::min_element(first.begin(), first.end());
}

/// Sum over all rows of what body(row, sum) adds to `sum`, begun at `zero` in every chunk. @pre body does not throw
template <class Sum, class Body>
Sum sum_over_rows(Workers& workers, int rows, const Sum& zero, const Body& body) {
  std::vector<Sum> parts(chunk_count(rows), zero);
  workers.run(chunk_count(rows), [&](int, int chunk) {
    Sum sum = zero;
    for (int i = chunk * kChunk, end = std::min(i + kChunk, rows); i < end; ++i) body(i, sum);
    parts[chunk] = sum;
  });
  Sum total = zero;
  for (const Sum& part : parts) total += part;
  return total;
}

}  // namespace holomorph
