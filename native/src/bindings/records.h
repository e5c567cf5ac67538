// Records of solves for Python.
#pragma once

namespace holomorph::bindings {

/// Largest relative residuals; 0 where a kind of result has none.
struct Residuals {
  double closedness = 0, harmonicity = 0, periods = 0, pairing = 0, asymmetry = 0;
};

}  // namespace holomorph::bindings
