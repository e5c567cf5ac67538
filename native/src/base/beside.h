// A piece of work on a thread of its own, beside what the calling thread does meanwhile.
#pragma once

#include <atomic>
#include <functional>
#include <future>

#include "base/progress.h"

namespace holomorph {

/// For work that one thread does: where all cores are busy with the caller's loops (base/workers.h), it takes its share
/// of them, and these wait for no thread that does not run. The caller sees to it that the two do not touch the same
/// values, so that no result depends on which is ahead.
class Beside {
 public:
  using Work = std::function<void(Progress&)>;

  /// Begins `work`, whose progress only cancels; what it refers to outlives this. Where the computation has one thread
  /// only, or the system no other, the work is done here and now, with `progress`.
  /// @throws what work that is done here throws
  Beside(Work work, Progress& progress);
  /// Work that has not been waited for is no longer wanted: it is cancelled.
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  /// Waits until the work is done. @throws what it threw, or Cancelled where the caller's function asks for that
  void wait(Progress& progress);

 private:
  std::atomic<bool> unwanted_{false};
  std::future<void> work_;  // invalid where it is done
};

}  // namespace holomorph
