#include "base/execution.h"

#include <algorithm>
#include <cmath>

namespace holomorph {

namespace {
thread_local std::uint64_t thread_work = 0;
}

void Execution::count(double operations) { thread_work += static_cast<std::uint64_t>(operations); }

std::uint64_t Execution::work() { return thread_work; }

void Execution::stage(const std::string& name, double begin, double end) {
  close_stage();
  name_ = name;
  begin_ = std::lerp(whole_begin_, whole_end_, begin);
  end_ = std::lerp(whole_begin_, whole_end_, end);
  part(0, 1);
  stage_start_ = Clock::now();
  if (callback_) call(begin_);
}

void Execution::finish() {
  if (callback_) call(whole_end_);
  close_stage();
}

Execution::Within::Within(Execution& execution)
    : execution_(execution), begin_(execution.whole_begin_), end_(execution.whole_end_), stage_(execution.name_) {
  execution_.whole_begin_ = std::lerp(execution.begin_, execution.end_, execution.part_begin_);
  execution_.whole_end_ = std::lerp(execution.begin_, execution.end_, execution.part_end_);
}

Execution::Within::~Within() {
  execution_.close_stage();
  execution_.whole_begin_ = begin_;
  execution_.whole_end_ = end_;
  execution_.name_ = stage_;
  execution_.stage_start_ = Clock::now();
}

void Execution::call(double fraction) {
  reported_ = std::max(reported_, std::min(fraction, 1.0));
  last_call_ = Clock::now();
  if (!callback_(reported_, name_)) throw Cancelled("cancelled during " + name_);
}

void Execution::close_stage() {
  if (name_.empty()) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - stage_start_).count();
  const auto same = std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == name_; });
  if (same == seconds_.end()) {
    seconds_.emplace_back(name_, elapsed);
  } else {
    same->second += elapsed;
  }
  name_.clear();
}

}  // namespace holomorph
