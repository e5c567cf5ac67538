#include "base/beside.h"

#include <chrono>
#include <system_error>

#include "base/thread_count.h"

namespace holomorph {
namespace {

// How often the caller's function may be asked while nothing else is done.
constexpr std::chrono::milliseconds kPause(10);

}  // namespace

Beside::Beside(Work work, Progress& progress) {
  if (thread_count() > 1) {
    try {
      work_ = std::async(std::launch::async, [this, work] {
        Progress only_cancels([this](double, const std::string&) { return !unwanted_.load(); });
        work(only_cancels);
      });
      return;
    } catch (const std::system_error&) {  // no more threads: the calling one does it
    }
  }
  work(progress);
}

Beside::~Beside() {
  unwanted_ = true;
  if (work_.valid()) work_.wait();
}

void Beside::wait(Progress& progress) {
  if (!work_.valid()) return;
  while (work_.wait_for(kPause) != std::future_status::ready) progress.report(0.0);
  work_.get();
}

}  // namespace holomorph
