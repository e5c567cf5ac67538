// The parts of the Python module, and the caller's progress function.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "base/execution.h"
#include "uv/direction.h"

namespace holomorph::bindings {

void bind_surfaces(pybind11::module_& m);
void bind_cuts(pybind11::module_& m);
void bind_progressive_meshes(pybind11::module_& m);
void bind_structures(pybind11::module_& m);
void bind_islands(pybind11::module_& m);
void bind_maps(pybind11::module_& m);
void bind_quality(pybind11::module_& m);
void bind_search(pybind11::module_& m);
void bind_tilings(pybind11::module_& m);
void bind_choice(pybind11::module_& m);
void bind_moduli(pybind11::module_& m);

/// Returns a progress function that looks for Ctrl-C, for callers who give none. Python runs signal handlers in the
/// main thread alone, which is busy here. @throws what the handler raises, mostly KeyboardInterrupt
inline Execution::Callback interruptible() {
  const auto threading = pybind11::module_::import("threading");
  if (!threading.attr("current_thread")().is(threading.attr("main_thread")())) return {};
  return [](double, const std::string&) {
    const pybind11::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    return true;
  };
}

/// Wraps the caller's progress function; None stands for no function. Python's function is called with the
/// interpreter's lock held. It answers False, Python's or NumPy's, to cancel.
inline Execution::Callback callback(const pybind11::object& progress) {
  if (progress.is_none()) return interruptible();
  return [progress](double fraction, const std::string& stage) {
    const pybind11::gil_scoped_acquire locked;
    const pybind11::object answer = progress(fraction, stage);
    pybind11::detail::make_caster<bool> is_true;
    return !is_true.load(answer, false) || static_cast<bool>(is_true);
  };
}

/// compute(execution) without the interpreter's lock, which only the progress function takes.
template <class Compute>
auto unlocked(int threads, const pybind11::object& progress, const Compute& compute) {
  Execution execution(threads, callback(progress));
  const pybind11::gil_scoped_release released;
  return compute(execution);
}

/// Python holds what the core does not change.
template <class Value>
std::shared_ptr<Value> shared(const std::shared_ptr<const Value>& value) {
  return std::const_pointer_cast<Value>(value);
}

/// The axis that `Surface.up` names.
inline uv::Up up_axis(const std::string& up) { return up == "Y" ? uv::Up::kY : uv::Up::kZ; }

}  // namespace holomorph::bindings
