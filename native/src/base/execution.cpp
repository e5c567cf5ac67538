#include "base/execution.h"

#include <algorithm>

namespace holomorph {

void Execution::stage(const std::string& name, double begin, double end) {
  close_stage();
  name_ = name;
  begin_ = begin;
  end_ = end;
  part(0, 1);
  stage_start_ = Clock::now();
  if (callback_) call(begin);
}

void Execution::finish() {
  if (callback_) call(1.0);
  close_stage();
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
