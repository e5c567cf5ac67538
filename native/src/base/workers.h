// Threads that share the chunks of one loop after another.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
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

  /// task(thread, chunk) for each of `chunks` chunks, once, on any thread and in any order; returns when all are done.
  /// From one thread at a time, and not from a task. @pre task does not throw; chunks < 2^24
  /// @param too_few chunks to wake a thread for
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

  // Number of the loop, above; chunks of it that nobody has taken yet, the lower 24 bits. A chunk is taken by lowering
  // this, which fails for a thread that still has an older loop in mind. Whoever has taken one may read the two below:
  // they are written only when all chunks of the loop before are done.
  std::atomic<std::uint64_t> open_{0};
  Call call_;
  int chunks_ = 0;
  std::atomic<int> done_{0};
  std::atomic<bool> end_{false};
  int count_ = 1;
  std::vector<std::thread> threads_;
};

}  // namespace holomorph
