// A task on a thread of its own, while the calling thread does something else.
#pragma once

#include <atomic>
#include <functional>
#include <future>

#include "base/execution.h"

namespace holomorph {

/// The caller sees to it that the two do not write what the other reads, so that no result depends on which is ahead.
/// The loops of the two share the processors: each waits only for threads that run (base/workers.h).
class BackgroundTask {
 public:
  using Work = std::function<void(Execution&)>;

  /// Begins `work` with an execution of its own, which has as many threads and reports nothing; what it refers to
  /// outlives this. Where the computation has one thread only, or the system no other, the work is done here and now,
  /// with `execution`. @throws what work that is done here throws
  BackgroundTask(Work work, Execution& execution);
  /// A task that has not been waited for is cancelled.
  ~BackgroundTask();
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Waits until the work is done. @throws what it threw, or Cancelled where the caller's function asks for that
  void wait(Execution& execution);

 private:
  std::atomic<bool> cancelled_{false};
  std::future<void> work_;  // invalid where it is done
};

}  // namespace holomorph
