#include "tiling/greens/greens_functions.h"

#include <algorithm>

namespace holomorph::tiling {

GreensFunctions GreensFunctions::on(std::shared_ptr<const PoleBasis> surface) && {
  GreensFunctions result(std::move(surface));
  result.known_ = std::move(known_);
  return result;
}

void GreensFunctions::solve_at(const std::vector<int>& vertices, Execution& execution) {
  std::vector<int> missing;
  for (const int v : vertices) {
    if (const int solved = basis_->solved_vertex(v); !known_.contains(solved)) missing.push_back(solved);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (auto first = missing.begin(); first != missing.end();) {
    const auto end = first + std::min<std::ptrdiff_t>(kGreensBlock, missing.end() - first);
    const MatrixXcd block = basis_->solve_greens({first, end}, execution);
    for (Index i = 0; i < block.cols(); ++i) known_.emplace(*first++, block.col(i));
  }
}

MatrixXcd GreensFunctions::at(const std::vector<int>& vertices, int every) const {
  const auto wanted = Eigen::seq(0, Eigen::last, every);
  const auto rows = (static_cast<Index>(basis_->samples().size()) + every - 1) / every;
  MatrixXcd values(rows, static_cast<Index>(vertices.size()));
  for (Index i = 0; i < values.cols(); ++i)
    values.col(i) = known_.at(basis_->solved_vertex(vertices[static_cast<std::size_t>(i)]))(wanted);
  // Solved for on the level: A belongs to the frames of its triangles.
  if (basis_->from_level().size() == 0) return values;
  return basis_->from_level()(wanted).asDiagonal() * values;
}

MatrixXcd GreensFunctions::pole_forms(const std::vector<int>& vertices, int every) const {
  const MatrixXcd each = at(vertices, every);
  if (!basis_->closed() || vertices.empty()) return each;
  const Index k = each.cols() - 1;
  return each.leftCols(k).colwise() - each.col(k);
}

}  // namespace holomorph::tiling
