// One function per class that Python sees, and one for UV maps.
#pragma once

#include <pybind11/pybind11.h>

namespace holomorph::bindings {

void bind_records(pybind11::module_& m);
void bind_surface(pybind11::module_& m);
void bind_islands(pybind11::module_& m);
void bind_structure(pybind11::module_& m);
void bind_progressive_mesh(pybind11::module_& m);
void bind_laplace_problem(pybind11::module_& m);
void bind_moduli(pybind11::module_& m);
void bind_nested_level(pybind11::module_& m);
void bind_plane_maps(pybind11::module_& m);
void bind_tiles(pybind11::module_& m);
void bind_tiling(pybind11::module_& m);
void bind_uv_maps(pybind11::module_& m);

}  // namespace holomorph::bindings
