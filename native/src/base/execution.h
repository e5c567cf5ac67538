// What a computation runs with: its threads, its progress function, and whether it has been cancelled.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/workers.h"

namespace holomorph {

/// One object is handed down through all stages of a computation. It reports how far the work has come, at most every
/// 20 ms and never backwards, and throws Cancelled when the caller's function answers false. It also counts the work in
/// operations. Not thread-safe: only the thread that began the work calls it, never a worker.
class Execution {
 public:
  /// `fraction` in [0, 1] of the whole work, `stage` a short name; the answer false cancels.
  using Callback = std::function<bool(double fraction, const std::string& stage)>;

  /// @param threads of the loops, the calling one included; 0: one for each processor. No result depends on it.
  explicit Execution(int threads = 0, Callback callback = {}) : callback_(std::move(callback)), workers_(threads) {}
  Execution(const Execution&) = delete;
  Execution& operator=(const Execution&) = delete;

  Workers& workers() { return workers_; }
  int threads() const { return workers_.count(); }

  /// Begins the stage that covers the fractions [begin, end] of the whole work, and ends the one before.
  void stage(const std::string& name, double begin, double end);

  /// Maps what is reported to the part [from, to] of the current stage, until the next stage or part begins.
  void part(double from, double to) {
    part_begin_ = from;
    part_end_ = to;
  }

  /// Says that `done` in [0, 1] of the current stage is done. Cheap enough to be called every few thousand elements.
  void report(double done) {
    if (callback_ && Clock::now() - last_call_ > kInterval)
      call(begin_ + (end_ - begin_) * (part_begin_ + (part_end_ - part_begin_) * done));
  }

  /// Adds operations, of about a nanosecond each, to `work`. Like the rest called by the thread that began the work.
  static void count(double operations);

  /// What was counted on the calling thread. Two calls before and after a computation tell what it took, the same at
  /// any number of threads; on another machine last bits, and so numbers of iterations, may differ.
  static std::uint64_t work();

  /// In a loop: counts a step, and reports every 4096th of `count` steps, which together are the part [from, to] of the
  /// current stage.
  void step(std::size_t i, std::size_t count, double from = 0.0, double to = 1.0) {
    if (i % 4096 != 0) return;
    Execution::count(static_cast<double>(std::min<std::size_t>(count - i, 4096)));
    report(from + (to - from) * static_cast<double>(i) / static_cast<double>(count));
  }

  /// Ends the last stage, and reports that all is done.
  void finish();

  /// While alive, maps the stages of a nested computation to the current stage or part.
  class Within {
   public:
    explicit Within(Execution& execution);
    ~Within();
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

   private:
    Execution& execution_;
    double begin_, end_;
    std::string stage_;
  };

  /// Seconds of wall time per stage, in the order in which they were first begun; a stage begun twice is summed.
  const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kInterval = std::chrono::milliseconds(20);

  void call(double fraction);
  void close_stage();

  Callback callback_;
  Workers workers_;
  std::string name_;
  double whole_begin_ = 0, whole_end_ = 1;  // what the stages are of, see Within
  double begin_ = 0, end_ = 0, part_begin_ = 0, part_end_ = 1, reported_ = 0;
  Clock::time_point stage_start_{}, last_call_{};
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace holomorph
