// Threads that share the chunks of one loop after another.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

namespace holomorph {

/// A cycle of multigrid is some thirty short loops. Where all threads meet at the end of each, as with OpenMP, every
/// meeting waits for whichever of them is not running. Here the calling thread takes chunks itself and waits only for
/// chunks that another has begun, so that a thread which comes late costs nothing.
class Workers {
 public:
  static constexpr int kTooFew = 2;  ///< chunks: less work than waking a thread

  /// @param threads the calling one included; 0: one for each processor. They are made when the first loop is long
  /// enough to be shared; fewer where the system has no more.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Number of the threads; the calling one is number 0.
  int count() const { return count_; }

  /// Calls task(thread, chunk) once for each of `chunks` chunks, on any thread and in any order, and returns when all
  /// are done. Only one thread may call this at a time, and no task may. @pre task does not throw; chunks < 2^24
  /// @param too_few chunks for which no thread is woken
  template <class Task>
  void run(int chunks, const Task& task, int too_few = kTooFew) {
    if (count_ == 1 || chunks <= too_few) {
      for (int c = 0; c < chunks; ++c) task(0, c);
    } else {
      share(chunks,
            {[](const void* t, int thread, int chunk) { (*static_cast<const Task*>(t))(thread, chunk); }, &task});
    }
  }

 private:
  struct Call {
    void (*function)(const void*, int, int) = nullptr;
    const void* task = nullptr;
  };

  void start();
  void share(int chunks, Call call);
  bool take(int thread);
  void work(int thread);

  // Upper bits: the number of the loop. Lower 24 bits: its chunks that no thread has taken yet. A thread takes a chunk
  // by lowering this, which fails if it still has an older loop in mind. A thread that has taken a chunk may read
  // `call_` and `chunks_`: they are written only when all chunks of the loop before are done.
  std::atomic<std::uint64_t> open_{0};
  Call call_;
  int chunks_ = 0;
  std::atomic<int> done_{0};
  std::atomic<bool> end_{false};
  int count_ = 1;
  std::vector<std::thread> threads_;
};

// Loops over rows that give the same bits at any number of threads. Chunks are fixed, and each row is written by one
// thread. Sums are taken per chunk, then in the order of the chunks. Which thread does a chunk changes nothing.

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
