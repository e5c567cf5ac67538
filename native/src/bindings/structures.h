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

/// The forms for UVs of a `Value`: all of them are kept, except where a closed surface has too many for its memory.
template <class Value>
struct FormsForUv {
  using Type = pipeline::KeptForms<Value>;
};
template <>
struct FormsForUv<pipeline::ConformalStructure> {
  using Type = pipeline::ArtistForms;
};

/// A result of the pipeline together with the surface that it belongs to, and the forms for UVs once they were asked
/// for. `Value` has harmonic, sheets, seams, solver, flip_count, mollification and seconds, and an overload of
/// pipeline::artist_forms.
template <class Value>
struct Structure {
  using Forms = typename FormsForUv<Value>::Type;

  std::shared_ptr<const mesh::Surface> surface;
  Value value;
  pipeline::Options options;
  std::mutex mutex;
  std::optional<Forms> forms;

  /// `use(forms, execution)` without the interpreter's lock, one call at a time.
  template <class Use>
  void with_forms(Use use, Execution::Callback callback = {}) {
    Execution execution(options.threads, std::move(callback));
    const py::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex);
    if (!forms) forms.emplace(*surface, value, options);
    use(*forms, execution);
  }
};

/// Runs `compute(options, execution)` without the interpreter's lock and keeps its value with the surface.
template <class Value, class Compute>
std::shared_ptr<Structure<Value>> make_structure(std::shared_ptr<mesh::Surface> surface,
                                                 const pipeline::Options& options, const py::object& progress_function,
                                                 Compute compute) {
  Execution execution(options.threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  auto structure = std::make_shared<Structure<Value>>();
  structure->options = options;
  structure->value = compute(options, execution);
  structure->surface = std::move(surface);
  return structure;
}

inline py::tuple report(const pipeline::SolverReport& solver) {
  py::list levels;
  for (const auto& level : solver.levels) levels.append(py::make_tuple(level.faces, level.iterations, level.seconds));
  return py::make_tuple(solver.name, solver.reason, solver.iterations, solver.residual, py::tuple(levels));
}

}  // namespace holomorph::bindings
