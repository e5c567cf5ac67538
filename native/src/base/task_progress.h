// The progress function of a computation inside a loop of long tasks.
#pragma once

#include <atomic>
#include <exception>

#include "base/execution.h"
#include "base/workers.h"

namespace holomorph {

/// Tasks call it every few milliseconds. Those of the calling thread report how far the loop has come. Once the caller
/// has cancelled, the tasks of all threads end.
class TaskProgress {
 public:
  /// @param steps number of calls after which the progress reported is one half: about half of those expected
  /// @param operations that each call stands for
  TaskProgress(Execution& execution, double steps, double operations)
      : execution_(execution), steps_(steps), operations_(operations) {}

  ~TaskProgress() { count(); }

  /// @param thread that the task runs on, 0 for the calling one. @throws Cancelled
  void operator()(int thread) {
    const auto done = static_cast<double>(done_.fetch_add(1, std::memory_order_relaxed));
    if (is_ended_.load(std::memory_order_acquire)) std::rethrow_exception(end_);
    if (thread != 0) return;
    count();
    try {
      execution_.report(done / (done + steps_));
    } catch (...) {
      end_ = std::current_exception();
      is_ended_.store(true, std::memory_order_release);
      throw;
    }
  }

 private:
  // The calls of all threads since the last time. Only the calling thread counts.
  void count() {
    const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
    Execution::count((done - counted_) * operations_);
    counted_ = done;
  }

  Execution& execution_;
  double steps_, operations_, counted_ = 0;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> is_ended_{false};
  std::exception_ptr end_;  // written before is_ended_
};

}  // namespace holomorph
