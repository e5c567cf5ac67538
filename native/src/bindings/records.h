// Records of solves and of maps for Python, and its handle of a Structure with lazily solved forms.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "structure/primal_forms.h"
#include "tiling/cones/turned_tiling.h"
#include "uv/zeros.h"

namespace holomorph::bindings {

/// Largest relative residuals; 0 where a kind of result has none.
struct Residuals {
  double closedness = 0, harmonicity = 0, periods = 0, pairing = 0, asymmetry = 0;
};

/// The vertices and the orders of the zeros of a form.
inline std::pair<py::array, py::array> zeros_by_columns(const std::vector<uv::Zero>& zeros) {
  std::vector<int> vertices, orders;
  for (const auto& [vertex, order] : zeros) {
    vertices.push_back(vertex);
    orders.push_back(order);
  }
  return {copy(vertices), copy(orders)};
}

/// "whole", "free", "mirror" or "none".
inline tiling::Rows rows_named(const std::string& lines) {
  if (lines == "whole") return tiling::Rows::kWhole;
  if (lines == "free") return tiling::Rows::kFree;
  return lines == "mirror" ? tiling::Rows::kMirror : tiling::Rows::kNone;
}

/// A structure for Python.
using Structure = structure::Solved;
using StructurePointer = std::shared_ptr<Structure>;

/// Calls use(forms, execution) without the interpreter's lock, one call at a time.
template <class Use>
void with_forms(Structure& s, const Use& use, Execution::Callback progress = interruptible()) {
  Execution execution(s.threads, std::move(progress));  // it goes with the lock held: it owns Python's function
  const py::gil_scoped_release unlocked;
  s.with_forms([&](structure::PrimalForms& forms) { use(forms, execution); });
}

}  // namespace holomorph::bindings
