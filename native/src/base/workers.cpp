#include "base/workers.h"

#include <algorithm>
#include <system_error>

#if defined(__x86_64__) || defined(_M_X64)
#include <immintrin.h>
#endif

namespace holomorph {
namespace {

constexpr int kCountBits = 24;
constexpr std::uint64_t kCount = (std::uint64_t{1} << kCountBits) - 1;
// Before a thread sleeps it looks again this often, about 20 us: longer than the pause between two loops.
constexpr int kLooks = 500;

void pause() {
#if defined(__x86_64__) || defined(_M_X64)
  _mm_pause();
#endif
}

// Waits until `value` is no longer `old`.
template <class T>
void wait_for_change(const std::atomic<T>& value, T old) {
  for (int look = 0; look < kLooks; ++look) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Workers::Workers(int threads)
    : count_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

Workers::~Workers() {
  end_.store(true, std::memory_order_release);
  open_.fetch_add(kCount + 1, std::memory_order_release);
  open_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::start() {
  try {
    for (int thread = 1; thread < count_; ++thread) threads_.emplace_back(&Workers::work, this, thread);
  } catch (const std::system_error&) {
    count_ = static_cast<int>(threads_.size()) + 1;  // thread creation failed: run on those already started
  }
}

void Workers::share(int chunks, Call call) {
  if (threads_.empty() && count_ > 1) start();
  call_ = call;
  chunks_ = chunks;
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t loop = (open_.load(std::memory_order_relaxed) >> kCountBits) + 1;
  open_.store(loop << kCountBits | static_cast<std::uint64_t>(chunks), std::memory_order_release);
  open_.notify_all();
  while (take(0)) {
  }
  for (int done = done_.load(std::memory_order_acquire); done != chunks; done = done_.load(std::memory_order_acquire)) {
    wait_for_change(done_, done);
  }
}

// Takes a chunk and does it, if there is one.
bool Workers::take(int thread) {
  std::uint64_t open = open_.load(std::memory_order_acquire);
  do {
    if ((open & kCount) == 0) return false;
  } while (!open_.compare_exchange_weak(open, open - 1, std::memory_order_acquire));
  const int chunks = chunks_;
  call_.function(call_.task, thread, chunks - static_cast<int>(open & kCount));
  if (done_.fetch_add(1, std::memory_order_acq_rel) + 1 == chunks) done_.notify_one();
  return true;
}

void Workers::work(int thread) {
  while (!end_.load(std::memory_order_acquire)) {
    const std::uint64_t open = open_.load(std::memory_order_acquire);
    if (!take(thread) && !end_.load(std::memory_order_acquire)) wait_for_change(open_, open);
  }
}

}  // namespace holomorph
