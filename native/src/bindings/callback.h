// The caller's progress function.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "base/execution.h"

namespace holomorph::bindings {

/// None is no function. It is called with the interpreter's lock held, and answers False to cancel.
inline Execution::Callback callback(const pybind11::object& progress) {
  if (progress.is_none()) return {};
  return [progress](double fraction, const std::string& stage) {
    const pybind11::gil_scoped_acquire locked;
    const pybind11::object answer = progress(fraction, stage);
    return !(answer.ptr() == Py_False);
  };
}

}  // namespace holomorph::bindings
