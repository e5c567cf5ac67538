// A task on a thread of its own, while the calling thread does something else.
#pragma once

#include <atomic>
#include <functional>
#include <future>

#include "base/execution.h"

namespace holomorph {

/// @pre neither of the two writes what the other reads: then no result depends on which is ahead. The loops of the two
/// share the processors: each waits only for threads that run (base/workers.h).
class BackgroundTask {
 public:
  using Work = std::function<void(Execution&)>;

  /// Starts `work` with an execution of its own, which has as many threads and reports nothing. What `work` refers to
  /// must outlive this. Where `execution` has one thread, or the system gives no other, the constructor does the work
  /// itself. @throws what `work` throws in that case
  BackgroundTask(Work work, Execution& execution);
  /// A task that has not been waited for is cancelled.
  ~BackgroundTask();
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Waits until the work is done. @throws what it threw, or Cancelled where the caller's function asks for that
  void wait(Execution& execution);

 private:
  std::atomic<bool> cancelled_{false};
  std::future<std::uint64_t> work_;  // what was counted; invalid where it is done
};

}  // namespace holomorph
