#include "tiling/rounding/symmetric_rounding.h"

#include <cmath>
#include <numbers>

#include "lattice/integer_kernel.h"
#include "tiling/poles/orbits.h"

namespace holomorph::tiling {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kTurned = 0.1;  // radians by which a phase may differ from a multiple of a quarter turn

lattice::IntegerVector coordinates(const TextureLattice& lattice, Complex z) {
  return lattice.coordinates(z).array().round().cast<std::int64_t>();
}

}  // namespace

std::optional<RoundingProblem> mirrored(const RoundingProblem& problem, const std::vector<int>& poles,
                                        const Mirror& mirror, RoundingOptions& options) {
  const TextureLattice& lattice = problem.lattice;
  const double quarters = std::round(options.phase.value_or(0) / kQuarter);
  if (!lattice.is_mirrored() || std::abs(options.phase.value_or(0) - quarters * kQuarter) > kTurned)
    return std::nullopt;
  // r' = conj(r) for u -> -u; a quarter turn, r -> i r, makes it r' = -conj(r) (docs/method/symmetry.md).
  const double sign = std::fmod(quarters, 2) == 0 ? 1 : -1;
  const auto count = static_cast<Index>(poles.size());
  MatrixXcd residues(count, problem.residues.cols());
  residues << problem.residues, -problem.residues.colwise().sum();
  lattice::IntegerMatrix unequal(2 * count, residues.cols());
  for (Index i = 0; i < count; ++i) {
    const Index size = orbit_size(poles, i, &mirror), image = size == 2 ? i + 1 : size == 1 ? i : i - 1;
    for (Index j = 0; j < residues.cols(); ++j) {
      // Each integer's part in r' - sign conj(r), in coordinates of the lattice. The integers wanted are its kernel.
      unequal.col(j).segment(2 * i, 2) =
          coordinates(lattice, residues(image, j)) - coordinates(lattice, sign * std::conj(residues(i, j)));
    }
  }
  const MatrixXcd basis = lattice::integer_kernel(unequal).cast<double>().cast<Complex>();
  if (basis.cols() == 0) return std::nullopt;
  options.phase = quarters * kQuarter;
  options.only_phase = true;
  RoundingProblem result = problem;
  result.periods = problem.periods * basis;
  result.residues = problem.residues * basis;
  result.Z = problem.Z * basis;
  return result;
}

}  // namespace holomorph::tiling
