// Results of the pipeline, kept for Python.
#pragma once

#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/callback.h"
#include "pipeline/artist_forms.h"

namespace holomorph::bindings {

/// A result of the pipeline together with the surface that it belongs to, and the forms for UVs once they were asked
/// for. `Value` has half_edges, harmonic, sheets, seams, solver, flip_count, mollification and seconds, and an overload
/// of pipeline::artist_forms.
template <class Value>
struct Structure {
  std::shared_ptr<const mesh::Surface> surface;
  Value value;
  pipeline::Options options;
  std::mutex mutex;
  std::optional<pipeline::HarmonicForms> artist_forms;

  // Called without the interpreter's lock.
  const forms::ClosedForms& forms_for_uv(Progress& progress) {
    const std::lock_guard<std::mutex> one_at_a_time(mutex);
    if (!artist_forms) artist_forms = pipeline::artist_forms(*surface, value, options, progress);
    return artist_forms->forms;
  }
  const forms::ClosedForms& forms_for_uv() {
    Progress silent;
    return forms_for_uv(silent);
  }
};

/// Runs `compute(options, progress)` without the interpreter's lock and keeps its value with the surface.
template <class Value, class Compute>
std::shared_ptr<Structure<Value>> make_structure(std::shared_ptr<mesh::Surface> surface,
                                                 const pipeline::Options& options, const py::object& progress_function,
                                                 Compute compute) {
  Progress progress(callback(progress_function));
  const py::gil_scoped_release unlocked;
  auto structure = std::make_shared<Structure<Value>>();
  structure->options = options;
  structure->value = compute(options, progress);
  structure->surface = std::move(surface);
  return structure;
}

}  // namespace holomorph::bindings
