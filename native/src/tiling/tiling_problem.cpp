#include "tiling/tiling_problem.h"

#include <Eigen/Cholesky>

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

struct Sizes {
  Index n, loops, handles, k, l;  // with straight loops and a boundary the handles' loops have v-periods, too
};

// Which period or residue each integer stands for, and the translation that it counts.
void set_integers(const TextureLattice& lattice, const Sizes& size, bool real, RoundingProblem& p) {
  const Index both = (real ? size.loops + size.handles : 2 * size.loops), D = both + (real ? 1 : 2) * size.k;
  p.periods = MatrixXcd::Zero(size.loops, D);
  p.residues = MatrixXcd::Zero(size.k, D);
  Index column = 0;
  for (Index j = 0; j < size.loops; ++j) {
    p.periods(j, column++) = lattice.a;
    if (!real || j < size.handles) p.periods(j, column++) = lattice.b;
  }
  for (Index i = 0; i < size.k; ++i) {
    p.residues(i, column++) = lattice.a;
    if (!real) p.residues(i, column++) = lattice.b;
  }
}

// The Dirichlet forms of the handles, those of the loops subtracted that lower their energy: A on the samples, up to i.
MatrixXcd handle_forms(const Landscape& landscape, const Sizes& size) {
  if (size.handles == 0) return MatrixXcd(static_cast<Index>(landscape.samples().size()), 0);
  const MatrixXd& G = landscape.structure().holomorphic().star.dirichlet_gram;
  const Index holes = size.n - size.handles;
  MatrixXd q = MatrixXd::Zero(size.n, size.handles);
  q.topRows(size.handles).setIdentity();
  if (holes > 0)
    q.bottomRows(holes) = -G.bottomRightCorner(holes, holes).ldlt().solve(G.bottomLeftCorner(holes, size.handles));
  return 0.5 * landscape.derivatives(landscape.samples()).rightCols(size.n) * q;
}

}  // namespace

MatrixXcd pole_forms(Landscape& landscape, const std::vector<int>& vertices, Execution& execution) {
  const MatrixXcd each = landscape.poles(vertices, execution);
  if (!landscape.closed() || vertices.empty()) return each;
  const Index k = each.cols() - 1;
  return each.leftCols(k).colwise() - each.col(k);
}

VectorXcd all_residues(const Landscape& landscape, std::size_t poles, const VectorXcd& free) {
  VectorXcd all(static_cast<Index>(poles));
  all.head(free.size()) = free;
  if (landscape.closed() && poles > 0) all[free.size()] = -free.sum();
  return all;
}

RoundingProblem tiling_problem(Landscape& landscape, const Poles& poles, uv::Coefficients kind,
                               const TextureLattice& lattice, const MatrixXd& parts, const Leverage* leverage,
                               Execution& execution) {
  const bool real = kind == uv::Coefficients::real, closed = landscape.closed();
  const auto& topology = landscape.structure().topology;
  Sizes size{landscape.form_count(), topology.families.natural, real ? 2 * topology.type.genus : 0, parts.cols(), 0};
  size.l = closed ? size.n : size.handles;
  RoundingProblem p;
  p.kind = kind;
  set_integers(lattice, size, real, p);

  const MatrixXcd at_poles = pole_forms(landscape, poles.vertices, execution);
  p.forms.resize(at_poles.rows(), size.n + size.k + size.l);
  p.target = VectorXcd::Zero(p.forms.cols());
  p.target.head(size.n) = poles.coefficients;
  p.target.segment(size.n, size.k) = poles.residues.head(size.k);

  const MatrixXcd X = p.periods + parts * p.residues;
  p.Z = MatrixXcd::Zero(p.forms.cols(), p.periods.cols());
  p.Z.middleRows(size.n, size.k) = p.residues;
  if (closed) {
    p.forms << landscape.holomorphic().M, at_poles, landscape.holomorphic().N.conjugate();
    p.defects = landscape.holomorphic().M.conjugate();
    if (leverage) {
      const MatrixXcd split = leverage->split() * X;
      p.Z.topRows(size.n) = split.topRows(size.n);
      p.Z.bottomRows(size.l) = split.bottomRows(size.l);
    }
  } else {
    const MatrixXcd of_handles = handle_forms(landscape, size);
    p.forms << landscape.holomorphic().M, at_poles, Complex(0, 1) * of_handles;
    p.defects = Complex(0, 1) * of_handles.conjugate();
    p.Z.topRows(size.n) = real ? MatrixXcd(X.real().cast<Complex>()) : X;
    const MatrixXd& star = landscape.structure().holomorphic().star.star;
    if (size.l > 0) {
      p.Z.bottomRows(size.l) =
          (p.periods.topRows(size.l).imag() - (star.transpose() * X.real()).topRows(size.l)).cast<Complex>();
    }
  }
  p.target_density = (p.forms * p.target).cwiseAbs2().array();
  p.target_ratio = density_ratio(p.target_density);
  p.symmetry = lattice.symmetry();
  return p;
}

}  // namespace holomorph::tiling
