#include "base/background_task.h"

#include <chrono>
#include <system_error>

namespace holomorph {
namespace {

// How often the caller's function may be asked while nothing else is done.
constexpr std::chrono::milliseconds kPause(10);

}  // namespace

BackgroundTask::BackgroundTask(Work work, Execution& execution) {
  if (execution.threads() > 1) {
    try {
      work_ = std::async(std::launch::async, [this, work, threads = execution.threads()] {
        Execution own(threads, [this](double, const std::string&) { return !cancelled_.load(); });
        work(own);
        return Execution::work();
      });
      return;
    } catch (const std::system_error&) {  // thread creation failed: the calling thread runs the task
    }
  }
  work(execution);
}

BackgroundTask::~BackgroundTask() {
  cancelled_ = true;
  if (work_.valid()) work_.wait();
}

void BackgroundTask::wait(Execution& execution) {
  if (!work_.valid()) return;
  while (work_.wait_for(kPause) != std::future_status::ready) execution.report(0.0);
  Execution::count(static_cast<double>(work_.get()));
}

}  // namespace holomorph
