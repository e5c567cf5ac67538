#include "choice/side_by_side.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>

#include "choice/part.h"

namespace holomorph::choice {
namespace {

constexpr int kLarge = 20'000;  // triangles from which on a part keeps all threads busy by itself
constexpr auto kTick = std::chrono::milliseconds(20);  // between two reports

using Work = std::function<void(int, Execution&)>;

// The threads that do the small parts. They write how far they have come, and the calling thread reads it.
class Crew {
 public:
  Crew(std::vector<int> parts, std::vector<double> shares, const Work& work)
      : parts_(std::move(parts)), shares_(std::move(shares)), work_(work), done_(parts_.size()) {}

  void run(int count, double before, Execution& execution) {
    std::vector<std::jthread> threads;
    left_ = count;
    for (int i = 0; i < count; ++i) threads.emplace_back([this] { several(); });
    try {
      while (!is_over()) execution.report(std::min(1.0, before + std::accumulate(done_.begin(), done_.end(), 0.0)));
    } catch (...) {
      goes_on_ = false;
      throw;
    }
    threads.clear();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  bool is_over() {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, kTick, [&] { return left_ == 0; });
  }

  // Takes one part after the other.
  void several() {
    for (std::size_t i = next_++; i < parts_.size() && goes_on_; i = next_++) {
      try {
        Execution execution(1, [&](double fraction, const std::string&) {
          done_[i] = fraction * shares_[i];
          return goes_on_.load();
        });
        execution.stage("map", 0.0, 1.0);
        work_(parts_[i], execution);
        done_[i] = shares_[i];
      } catch (const Cancelled&) {
        goes_on_ = false;
      } catch (...) {
        failed(parts_[i], std::current_exception());
      }
    }
    const std::lock_guard lock(mutex_);
    --left_;
    ended_.notify_one();
  }

  void failed(int part, std::exception_ptr error) {
    goes_on_ = false;
    const std::lock_guard lock(mutex_);
    if (error_ && part_ < part) return;
    error_ = std::move(error);
    part_ = part;
  }

  std::vector<int> parts_;
  std::vector<double> shares_;
  const Work& work_;
  std::vector<std::atomic<double>> done_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> goes_on_{true};
  std::mutex mutex_;
  std::condition_variable ended_;
  int left_ = 0;
  std::exception_ptr error_;
  int part_ = 0;
};

}  // namespace

void side_by_side(const std::vector<int>& sizes, Execution& execution, const Work& work) {
  std::vector<int> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](int k) { return sizes[k]; });
  const double total = std::max(1.0, std::accumulate(sizes.begin(), sizes.end(), 0.0));
  double done = 0;
  std::size_t at = 0;
  const bool are_one_by_one = execution.threads() == 1 || order.size() == 1;
  for (; at < order.size() && (are_one_by_one || sizes[order[at]] >= kLarge); ++at) {
    const double share = sizes[order[at]] / total;
    nested(execution, done, std::min(1.0, done + share), [&] {
      execution.stage("map", 0.0, 1.0);
      work(order[at], execution);
    });
    done += share;
  }
  if (at == order.size()) return;
  std::vector<int> small(order.begin() + static_cast<std::ptrdiff_t>(at), order.end());
  std::vector<double> shares;
  for (const int k : small) shares.push_back(sizes[k] / total);
  const int count = std::min(execution.threads(), static_cast<int>(small.size()));
  execution.part(0.0, 1.0);
  Crew(std::move(small), std::move(shares), work).run(count, done, execution);
}

}  // namespace holomorph::choice
