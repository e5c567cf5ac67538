// Records of solves and of maps for Python, and its handle of a Structure with lazily solved forms.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "structure/primal_forms.h"
#include "uv/zeros.h"

namespace holomorph::bindings {

/// Largest relative residuals; 0 where a kind of result has none.
struct Residuals {
  double closedness = 0, harmonicity = 0, periods = 0, pairing = 0, asymmetry = 0;
};

/// The zeros of a form by columns.
struct Zeros {
  std::vector<int> vertices, orders;
};

inline Zeros zeros_of_map(const mesh::Surface& surface, const Eigen::Ref<const uv::UvArray>& uv,
                          const std::vector<int>& poles) {
  Zeros found;
  for (const auto& [vertex, order] : uv::zeros(surface, uv, poles)) {
    found.vertices.push_back(vertex);
    found.orders.push_back(order);
  }
  return found;
}

/// A structure for Python: the forms that UVs are made of come with it, solved for when first asked for.
struct Structure {
  structure::Options options;
  int threads = 0;
  structure::Structure value;
  std::mutex mutex;
  std::atomic<std::thread::id> user;              ///< the thread that uses the forms
  std::unique_ptr<structure::PrimalForms> forms;  ///< none of a structure that was cut
  std::shared_ptr<Structure> uncut;               ///< where this was cut: the one whose forms it shares

  /// Calls use(forms, execution) without the interpreter's lock, one call at a time. A call from within the progress
  /// function of another, on the same thread, would wait for itself: it gets forms of its own.
  template <class Use>
  void with_forms(Use use, Execution::Callback progress = interruptible()) {
    Structure& owner = uncut ? *uncut : *this;
    Execution execution(threads, std::move(progress));  // it goes with the lock held: it owns Python's function
    const py::gil_scoped_release unlocked;
    if (owner.user == std::this_thread::get_id())
      return use(*structure::primal_forms(owner.value, owner.options), execution);
    const std::lock_guard<std::mutex> one_at_a_time(owner.mutex);
    owner.user = std::this_thread::get_id();
    const std::unique_ptr<Structure, void (*)(Structure*)> end(&owner,
                                                               [](Structure* used) { used->user = std::thread::id(); });
    use(*owner.forms, execution);
  }
};
using StructurePointer = std::shared_ptr<Structure>;

}  // namespace holomorph::bindings
