// The combination of holomorphic forms that is shown first.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/workers.h"
#include "forms/closed_forms.h"
#include "mesh/surface.h"

namespace holomorph::uv {

/// Samples of forms for the balance: their values on two sides of a few thousand triangles.
struct FormSamples {
  std::vector<int> triangles;      ///< evenly spaced by area; all of them on a small surface, some more than once
  forms::RowMajorMatrix on_sides;  ///< (2 #triangles) x #forms, along sides 0 and 1 of each
};
std::vector<int> sample_triangles(const mesh::Surface& surface);
forms::RowMajorMatrix values_on_sides(const mesh::Surface& surface, const forms::ClosedForms& forms,
                                      const std::vector<int>& triangles);

enum class Coefficients { complex, real };

/// Coefficients c, g numbers, for which the texture density |theta|^2 of theta = sum_j c_j theta_j is most
/// even: least variance over the surface's area of log(|theta|^2 / mean + 1e-4), plus a small term against distortion
/// (balance.cpp); the scale is free. The minimum is local, the best from several fixed starts; the same
/// input gives the same bits.
/// @param samples not used where g = 1
/// @param basis #forms x g, the theta_j in the forms
/// @param kind real on bounded surfaces, so that boundaries remain straight
Eigen::VectorXcd balanced_coefficients(const mesh::Surface& surface, const FormSamples& samples,
                                       const Eigen::MatrixXcd& basis, Coefficients kind, Workers& workers);

}  // namespace holomorph::uv
