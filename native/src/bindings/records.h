// Records of solves and of maps for Python.
#pragma once

#include <vector>

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

}  // namespace holomorph::bindings
