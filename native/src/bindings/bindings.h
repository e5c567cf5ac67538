// One function per class that Python sees, and one for UV maps.
#pragma once

#include <pybind11/pybind11.h>

namespace holomorph::bindings {

void bind_surface(pybind11::module_& m);
void bind_conformal_structure(pybind11::module_& m);
void bind_bounded_structure(pybind11::module_& m);
void bind_progressive_mesh(pybind11::module_& m);
void bind_laplace_problem(pybind11::module_& m);
void bind_punctured_structure(pybind11::module_& m);
void bind_rectangle(pybind11::module_& m);
void bind_uv_maps(pybind11::module_& m);

}  // namespace holomorph::bindings
