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

}  // namespace holomorph
