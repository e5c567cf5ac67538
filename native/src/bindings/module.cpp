// The Python module _native: arrays in and out, the interpreter's lock released, errors mapped. No algorithm.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <new>

#include "base/errors.h"
#include "bindings/bindings.h"
#include "solver/direct/sparse_cholesky.h"

namespace py = pybind11;
using namespace holomorph;

namespace {

template <class Exception>
py::exception<Exception>& declare(py::module_& m, const char* name, py::handle base, const char* doc) {
  auto& exception = py::register_exception<Exception>(m, name, base);
  exception.attr("__module__") = "holomorph";
  exception.attr("__doc__") = doc;
  return exception;
}

// Both an error of ours and a MemoryError. It lives as long as the process, as all of these do.
PyObject* out_of_memory = nullptr;

void declare_out_of_memory(py::module_& m, const py::object& base) {
  const auto bases = py::make_tuple(base, py::handle(PyExc_MemoryError));
  out_of_memory =
      PyErr_NewExceptionWithDoc("holomorph.OutOfMemory", "There is not enough memory.", bases.ptr(), nullptr);
  if (out_of_memory == nullptr) throw py::error_already_set();
  m.add_object("OutOfMemory", out_of_memory);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      PyErr_SetString(out_of_memory, "there is not enough memory for a mesh of this size");
    }
  });
}

}  // namespace

PYBIND11_MODULE(_native, m) {
  m.attr("__version__") = HOLOMORPH_VERSION;
  m.def("work", &holomorph::Execution::work);
  m.attr("direct_solver") = solver::SparseCholesky::name();
  auto& base = declare<Error>(m, "Error", PyExc_RuntimeError, "Base of all errors of this library.");
  declare<InvalidMesh>(m, "InvalidMesh", base, "The input is not a valid polygon mesh, or a file is malformed.");
  declare<TopologyError>(m, "TopologyError", base, "The topology of the mesh does not fit what was asked for.");
  declare<SolverError>(m, "SolverError", base,
                       "A linear system was not solved to the accuracy asked for, or does not fit into memory.");
  declare<Cancelled>(m, "Cancelled", base, "The progress function returned False.");
  declare_out_of_memory(m, base);
  bindings::bind_surfaces(m);
  bindings::bind_cuts(m);
  bindings::bind_progressive_meshes(m);
  bindings::bind_maps(m);
  bindings::bind_quality(m);
  bindings::bind_islands(m);
  bindings::bind_structures(m);
  bindings::bind_tilings(m);
  bindings::bind_search(m);
  bindings::bind_choice(m);
  bindings::bind_moduli(m);
}
