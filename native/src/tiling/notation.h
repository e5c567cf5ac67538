// The short names of matrices in this room.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

}  // namespace holomorph::tiling
