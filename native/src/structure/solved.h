// A structure with the forms that its maps are made of, shared by several callers.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "structure/primal_forms.h"

namespace holomorph::structure {

/// The forms are solved for when first asked for, and used by one caller at a time.
struct Solved {
  Options options;
  int threads = 0;  ///< as it was asked for, see `Execution`
  Structure value;
  std::mutex mutex;
  std::atomic<std::thread::id> user;   ///< the thread that uses the forms
  std::unique_ptr<PrimalForms> forms;  ///< none of a structure that was cut
  std::shared_ptr<Solved> uncut;       ///< where this was cut: the one whose forms it shares

  /// Calls use(forms). A call from within the progress function of another, on the same thread, would wait for itself:
  /// it gets forms of its own.
  template <class Use>
  void with_forms(const Use& use) {
    Solved& owner = uncut ? *uncut : *this;
    if (owner.user == std::this_thread::get_id()) return use(*primal_forms(owner.value, owner.options));
    const std::lock_guard<std::mutex> one_at_a_time(owner.mutex);
    owner.user = std::this_thread::get_id();
    const std::unique_ptr<Solved, void (*)(Solved*)> end(&owner, [](Solved* used) { used->user = std::thread::id(); });
    use(*owner.forms);
  }
};

/// @param compute(options, execution) the structure
template <class Compute>
std::shared_ptr<Solved> solved(const Options& options, Execution& execution, const Compute& compute) {
  auto made = std::make_shared<Solved>();
  made->options = options;
  made->threads = execution.threads();
  made->value = compute(options, execution);
  made->forms = primal_forms(made->value, made->options);
  return made;
}

}  // namespace holomorph::structure
