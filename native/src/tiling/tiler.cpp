#include "tiling/tiler.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/chunks.h"
#include "base/errors.h"
#include "structure/punctured_structure.h"
#include "tiling/coarse_level.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

// Poles by themselves: none where the density is even enough without, else the first of these numbers with which it is.
constexpr int kCounts[] = {2, 4, 8, 12, 16};
constexpr double kEvenWithout = 3, kEvenWith = 6;
constexpr double kReach = 0.05;  // how far poles are expected to move, in square roots of the area
constexpr double kMoreTiles = 1.5, kMostTiles = 1e6;

// Complex tangent vectors e_x + i e_y, x along side 0: the one-form A dz as a vector of space is A times this.
Eigen::Vector3cd frame(const mesh::Surface& surface, int triangle) {
  const auto corner = [&](int i) {
    const auto& position = surface.polygons.vertices[surface.triangles[triangle][i]];
    return Eigen::Vector3d(position[0], position[1], position[2]);
  };
  const Eigen::Vector3d x = (corner(1) - corner(0)).stableNormalized();
  const Eigen::Vector3d normal = x.cross(corner(2) - corner(0)).stableNormalized();
  return x.cast<Complex>() + Complex(0, 1) * normal.cross(x).cast<Complex>();
}

MatrixXcd frames(const mesh::Surface& surface, const std::vector<int>& triangles) {
  MatrixXcd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) result.col(s) = frame(surface, triangles[s]);
  return result;
}

// The natural classes of `old` over the loops of a structure of the same polygons: integers.
MatrixXd change_of_basis(const topology::IntegerForms& old, const structure::Structure& s) {
  const int count = s.topology.families.natural;
  MatrixXd N = MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i) {
    for (const mesh::HalfedgeHandle h : s.topology.homology_basis[i]) {
      assert(!s.surface->is_diagonal(mesh::edge_of(h)));  // which may be flipped
      for (const auto& [form, value] : topology::forms_between(old.rows[mesh::edge_of(h)], 0, count))
        N(i, form) += mesh::sign(h) * value;
    }
  }
  return N;
}

std::string text(double number) {
  std::ostringstream out;
  out.precision(3);
  out << number;
  return out.str();
}

}  // namespace

Tiler::Tiler(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, bool straight,
             std::vector<int> names, Execution&)
    : surface_(std::move(surface)), options_(options), names_(std::move(names)) {
  const auto type = mesh::topological_type(*surface_);
  // With handles and a boundary the loops are straight: free ones would need the forms of the double.
  const bool real = !type.closed() && (straight || type.genus > 0);
  kind_ = real ? uv::Coefficients::real : uv::Coefficients::complex;
}

void Tiler::place(const PoleWishes& wishes, Execution& execution) {
  fixed_ = !wishes.vertices.empty();
  execution.stage("level for the poles", 0.0, 0.1);
  const auto level = wishes.vertices.empty() ? coarse_level(surface_, execution)
                                             : CoarseLevel{surface_, {}};
  const bool own = level.surface == surface_;
  execution.stage("forms of the level", 0.1, 0.2);
  auto landscape = std::make_unique<Landscape>(level.surface, options_, execution);
  PlacementRules rules{kind_, {}, wishes.vertices};
  if (!wishes.allowed.empty()) {
    for (int v = 0; v < level.surface->vertex_count; ++v)
      rules.allowed.push_back(wishes.allowed[own ? v : level.vertex[v]]);
  }
  execution.stage("poles", 0.2, 0.7);
  Poles poles = without_more_poles(*landscape, rules, execution);
  if (wishes.count) {
    if (landscape->closed() && *wishes.count + wishes.vertices.size() > 0 && std::max<std::size_t>(*wishes.count, poles.vertices.size()) == 1)
      throw TopologyError("one pole is not enough on a closed surface, where the residues sum to 0: two or more are needed");
    if (*wishes.count > static_cast<int>(poles.vertices.size()))
      poles = with_more_poles(*landscape, rules, std::move(poles), *wishes.count, execution);
  } else if (wishes.vertices.empty()) {
    const bool bare = poles.vertices.empty();
    for (const int count : kCounts) {
      const double ratio = density_ratio(density(*landscape, poles, execution));
      if (ratio <= (bare && poles.vertices.empty() ? kEvenWithout : kEvenWith)) break;
      if (count > static_cast<int>(poles.vertices.size()))
        poles = with_more_poles(*landscape, rules, std::move(poles), count, execution);
    }
  }
  execution.stage("forms of the surface", 0.7, 1.0);
  if (own) {
    landscape_ = std::move(landscape);
    poles_ = std::move(poles);
  } else {
    transfer(*landscape, level.vertex, std::move(poles), execution);
  }
  optimum_ = density_ratio(density(*landscape_, poles_, execution));
  abel_jacobi_.reset();
  if (moves()) {
    abel_jacobi_ = std::make_unique<AbelJacobi>(*landscape_, execution);
    pole_moves_ = std::make_unique<PoleMoves>(*landscape_, *abel_jacobi_);
  }
  execution.finish();
}

// The same form on the surface: the same residues, and c_j that fit it as a vector field in space.
void Tiler::transfer(Landscape& level, const std::vector<int>& vertex, Poles poles, Execution& execution) {
  std::vector<int> first_triangle(surface_->vertex_count, -1);
  for (int t = 0; t < static_cast<int>(surface_->triangles.size()); ++t) {
    for (const int v : surface_->triangles[t]) first_triangle[v] = t;
  }
  std::vector<int> samples;
  for (const int t : level.samples()) samples.push_back(first_triangle[vertex[level.surface().triangles[t][0]]]);
  const VectorXcd wanted = level.holomorphic().M * poles.coefficients +
                           level.poles(poles.vertices, execution) * poles.residues;
  const MatrixXcd level_frames = frames(level.surface(), level.samples());
  for (int& v : poles.vertices) v = vertex[v];
  landscape_ = std::make_unique<Landscape>(surface_, options_, execution, std::move(samples));
  const MatrixXcd of_poles = landscape_->poles(poles.vertices, execution);
  if (landscape_->form_count() > 0) {
    const MatrixXcd own_frames = frames(*surface_, landscape_->samples());
    const VectorXcd known = of_poles * poles.residues;
    const auto n = landscape_->form_count();
    MatrixXcd rows(3 * wanted.size(), n);
    VectorXcd right(3 * wanted.size());
    for (Index s = 0; s < wanted.size(); ++s) {
      const double weight = 1 / (std::abs(wanted[s]) + 1e-300);
      rows.middleRows(3 * s, 3) = weight * own_frames.col(s) * landscape_->holomorphic().M.row(s);
      right.segment(3 * s, 3) = weight * (wanted[s] * level_frames.col(s) - known[s] * own_frames.col(s));
    }
    const VectorXcd fit = kind_ == uv::Coefficients::real
                              ? VectorXcd((rows.adjoint() * rows).real().ldlt().solve((rows.adjoint() * right).real()))
                              : VectorXcd((rows.adjoint() * rows).ldlt().solve(rows.adjoint() * right));
    poles.coefficients = fit;
  }
  poles_ = optimised(*landscape_, {kind_, {}, {}}, std::move(poles), execution);
}

std::shared_ptr<structure::Structure> Tiler::structure_at(const std::vector<int>& vertices, Execution& execution) {
  if (structure_ && structure_poles_ == vertices) return structure_;
  if (vertices.empty()) {
    structure_ = std::make_shared<structure::Structure>(landscape_->structure());
    structure_->functions = landscape_->harmonic().functions;
    structure_->pole_parts.resize(structure_->topology.families.natural, 0);
  } else {
    structure::Punctures punctures{vertices, std::vector<Complex>(vertices.size(), 1.0), names_};
    if (landscape_->closed()) punctures.residues.back() = -static_cast<double>(vertices.size() - 1);
    structure_ = std::make_shared<structure::Structure>(
        structure::punctured_structure(surface_, std::move(punctures), options_, execution));
  }
  structure_poles_ = vertices;
  return structure_;
}

// The harmonic parts C of the poles in the classes of the landscape.
MatrixXd Tiler::parts_of(const structure::Structure& s) const {
  if (s.topology.families.natural == 0) return s.pole_parts;
  return change_of_basis(landscape_->structure().topology.classes, s).inverse() * s.pole_parts;
}

RoundingProblem Tiler::problem(const TextureLattice& lattice, const MatrixXd& parts, Execution& execution) {
  const Landscape& land = *landscape_;
  const bool real = kind_ == uv::Coefficients::real, closed = land.closed();
  const auto& type = land.structure().topology.type;
  const Index n = land.form_count(), natural = land.structure().topology.families.natural;
  const Index k = parts.cols(), handles = closed ? 0 : 2 * type.genus, l = closed ? n : handles;
  RoundingProblem p;
  p.kind = kind_;
  MatrixXcd pole_forms = landscape_->poles(poles_.vertices, execution);
  if (closed && k > 0) pole_forms = (pole_forms.leftCols(k).colwise() - pole_forms.col(k)).eval();
  p.forms.resize(land.holomorphic().M.rows(), n + k + l);
  p.forms << land.holomorphic().M, pole_forms.leftCols(k), MatrixXcd::Zero(p.forms.rows(), l);
  p.target = VectorXcd::Zero(n + k + l);
  p.target << poles_.coefficients, poles_.residues.head(k), VectorXcd::Zero(l);
  const MatrixXd& star = land.structure().holomorphic.star.star;
  if (closed) {
    p.forms.rightCols(l) = land.holomorphic().N.conjugate();
    p.defects = land.holomorphic().M.conjugate();
  } else if (handles > 0) {  // h^D of the handles, those of the loops, which are free, subtracted
    const MatrixXd& G = land.structure().holomorphic.star.dirichlet_gram;
    const Index loops = n - handles;
    MatrixXd q = MatrixXd::Zero(n, handles);
    q.topRows(handles).setIdentity();
    if (loops > 0)
      q.bottomRows(loops) = -G.bottomRightCorner(loops, loops).ldlt().solve(G.bottomLeftCorner(loops, handles));
    const MatrixXcd dirichlet = 0.5 * land.derivatives(land.samples()).rightCols(n) * q;
    p.forms.rightCols(l) = Complex(0, 1) * dirichlet;
    p.defects = Complex(0, 1) * dirichlet.conjugate();
  }

  std::vector<VectorXcd> columns;
  const auto add = [&](const VectorXcd& periods, const VectorXcd& residues) {
    VectorXcd y = VectorXcd::Zero(n + k + l);
    y.segment(n, k) = residues;
    const VectorXcd X = periods + parts * residues;
    if (closed && n > 0) {
      const VectorXcd split = pole_moves_->leverage().split(X);
      y.head(n) = split.head(n);
      y.tail(n) = split.tail(n);
    } else if (!closed) {
      y.head(n) = real ? VectorXcd(X.real()) : X;
      if (handles > 0)
        y.tail(l) = periods.head(handles).imag() - (star.transpose() * X.real()).head(handles);
    }
    columns.push_back(std::move(y));
  };
  const VectorXcd none = VectorXcd::Zero(natural), no_residue = VectorXcd::Zero(k);
  for (Index j = 0; j < natural; ++j) {
    add(lattice.a * VectorXcd::Unit(natural, j), no_residue);
    if (!real || j < handles) add(lattice.b * VectorXcd::Unit(natural, j), no_residue);
  }
  for (Index i = 0; i < k; ++i) {
    add(none, lattice.a * VectorXcd::Unit(k, i));
    if (!real) add(none, lattice.b * VectorXcd::Unit(k, i));
  }
  p.Z.resize(n + k + l, static_cast<Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) p.Z.col(static_cast<Index>(j)) = columns[j];
  return p;
}

double Tiler::phase_along(const std::array<double, 3>& direction, Execution& execution) {
  const Eigen::RowVector3d axis = Eigen::Map<const Eigen::RowVector3d>(direction.data());
  const VectorXcd A = landscape_->holomorphic().M * poles_.coefficients +
                      landscape_->poles(poles_.vertices, execution) * poles_.residues;
  const MatrixXcd along = axis.cast<Complex>() * frames(landscape_->surface(), landscape_->samples());
  const Eigen::ArrayXcd flow = along.transpose().array() * A.array() / A.array().abs().max(1e-300).cast<Complex>();
  // A texture's axis has no sign where it averages out.
  const Complex turn = std::polar(1.0, -std::arg(flow.square().sum()) / 2);
  return std::arg((turn * flow.sum()).real() < 0 ? -turn : turn);
}

Tiling Tiler::tile(const TilingWishes& wishes, Execution& execution) {
  execution.stage("rounding", 0.0, 0.4);
  const Landscape& land = *landscape_;
  const auto count = static_cast<Index>(poles_.vertices.size());
  const Index free = land.closed() ? std::max<Index>(0, count - 1) : count;
  PlacedPoles placed{poles_.vertices, {}};
  MatrixXd parts;
  if (moves()) {
    parts.resize(land.structure().topology.families.natural, free);
    for (const int v : poles_.vertices) placed.parts.push_back(abel_jacobi_->at(v));
    for (Index i = 0; i < free; ++i) parts.col(i) = placed.parts[i] - placed.parts.back();
  } else {
    parts = parts_of(*structure_at(poles_.vertices, execution));
  }
  RoundingProblem p = problem(wishes.lattice, parts, execution);
  const Index n = land.form_count(), natural = land.structure().topology.families.natural;
  const bool may_move = moves() && free > 0 && !fixed_;
  MatrixXcd metric;
  if (p.defects.cols() > 0) {
    const Eigen::ArrayXd density = (p.forms * p.target).cwiseAbs2().array();
    const Eigen::ArrayXd weight = 1 / ((density + uv::kDensityFloor * density.mean()) * static_cast<double>(density.size()));
    const MatrixXcd gram = p.defects.adjoint() * weight.matrix().cast<Complex>().asDiagonal() * p.defects;
    metric = Eigen::LLT<MatrixXcd>(gram).matrixU();
    if (may_move) {
      std::vector<int> triangles(count, -1);
      for (int t = static_cast<int>(surface_->triangles.size()) - 1; t >= 0; --t) {
        for (Index i = 0; i < count; ++i) {
          const auto& v = surface_->triangles[t];
          if (std::find(v.begin(), v.end(), poles_.vertices[i]) != v.end()) triangles[i] = t;
        }
      }
      const MatrixXcd reach = pole_moves_->leverage().tau(triangles) * poles_.residues.asDiagonal();
      p.repairable = kReach * kReach * land.area() * reach * reach.adjoint();
    }
  }
  RoundingWishes rounding{wishes.tiles > 0 ? wishes.tiles : std::max(100.0, 64.0 * land.structure().topology.type.genus),
                          land.area(), wishes.phase, wishes.turn};
  if (wishes.direction) rounding.phase = phase_along(*wishes.direction, execution) + wishes.phase.value_or(0);
  std::vector<Rounding> list = roundings(p, rounding, execution);
  if (list.empty()) {
    double enough = rounding.tiles;
    for (RoundingWishes more = rounding; list.empty() && enough < kMostTiles;) {
      more.tiles = enough *= kMoreTiles;
      list = roundings(p, more, execution);
    }
    throw TopologyError("with " + text(rounding.tiles) + " tiles no map is seamless on this surface; " + text(enough) +
                        " are enough");
  }

  // The periods are the first integers of z.
  const bool real = kind_ == uv::Coefficients::real;
  const Index handles = land.closed() ? natural : 2 * land.structure().topology.type.genus;
  struct Candidate {
    VectorXcd periods, residues;  // residues of all poles
    PlacedPoles poles;
    Rounding rounding;
  };
  std::vector<Candidate> candidates(list.size());
  run_throwing(execution.workers(), static_cast<int>(list.size()), [&](int c) {
    Candidate& candidate = candidates[c];
    candidate.rounding = list[c];
    Index next = 0;
    const auto number = [&](bool is_real) {
      const double a = static_cast<double>(list[c].z[next++]);
      return wishes.lattice.point(a, is_real ? 0.0 : static_cast<double>(list[c].z[next++]));
    };
    candidate.periods.resize(natural);
    for (Index j = 0; j < natural; ++j) candidate.periods[j] = number(real && j >= handles);
    candidate.residues = VectorXcd::Zero(count);
    for (Index i = 0; i < free; ++i) candidate.residues[i] = number(real);
    if (count > free) candidate.residues[free] = -candidate.residues.head(free).sum();
    candidate.poles = placed;
    if (!may_move) return;
    const double scale = std::sqrt(rounding.tiles);
    candidate.poles = pole_moves_->moved(placed, candidate.periods, candidate.residues, metric / scale, {});
    candidate.rounding.y.tail(n) = pole_moves_->left_over(candidate.poles, candidate.periods, candidate.residues);
    measure(p, candidate.rounding);
  });
  const auto rank = [&](const Candidate& c) {
    return c.rounding.distortion - 1 + 0.15 * std::max(0.0, std::log(c.rounding.density_ratio / (1.1 * optimum_)));
  };
  const Candidate& best = *std::min_element(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    return rank(a) < rank(b);
  });

  execution.stage("poles at their places", 0.4, 0.9);
  std::vector<int> vertices;
  std::vector<Complex> residues;
  for (Index i = 0; i < count; ++i) {
    if (best.residues[i] == Complex(0)) continue;
    vertices.push_back(best.poles.vertices[i]);
    residues.push_back(best.residues[i]);
  }
  const auto s = structure_at(vertices, execution);
  const auto& families = s->topology.families;
  const VectorXcd r = Eigen::Map<const VectorXcd>(residues.data(), families.poles);
  const MatrixXd N = change_of_basis(land.structure().topology.classes, *s);
  Tiling result;
  result.coefficients = VectorXcd::Zero(families.count());
  auto& q = result.coefficients;
  q.segment(families.harmonic(), families.poles) = r;
  q.tail(families.poles) = Complex(0, 1) * r;
  VectorXcd periods(families.natural);
  if (land.closed()) {
    VectorXcd X = best.periods;
    if (moves()) {
      for (Index i = 0; i < count; ++i) X += best.residues[i] * best.poles.parts[i];
    }
    const VectorXcd wanted = N * X - s->pole_parts * r;
    for (Index j = 0; j < wanted.size(); ++j) periods[j] = wishes.lattice.nearest(wanted[j]);
    q.head(families.natural) = periods;
  } else {
    const VectorXcd wanted = N * best.rounding.y.head(n) - s->pole_parts * r;
    VectorXcd c = wanted;
    for (Index j = 0; j < wanted.size(); ++j) c[j] = periods[j] = real ? Complex(std::round(wanted[j].real())) : wishes.lattice.nearest(wanted[j]);
    c += s->pole_parts * r;
    q.head(families.harmonic()) += s->holomorphic.differentials * c;
    q.head(families.natural) = periods;
  }
  result.periods = periods;
  result.structure = s;
  result.poles = vertices;
  result.residues = residues;
  result.tiles = rounding.tiles;
  result.distortion = best.rounding.distortion;
  if (p.defects.cols() > 0)
    result.left_over = (metric * best.rounding.y.tail(metric.cols())).norm() / std::sqrt(rounding.tiles);

  execution.stage("UV map", 0.9, 1.0);
  Eigen::Matrix<double, Eigen::Dynamic, 2> coefficients(q.size(), 2);
  coefficients << q.real(), q.imag();
  uv::UvArray function = s->functions * coefficients;
  // Centred by whole tiles, and on a grid that single precision holds, so that the two sides of a cut differ exactly by
  // their jump there, too.
  const Eigen::RowVector2d middle = ((function.colwise().maxCoeff() + function.colwise().minCoeff()) / 2).array().round();
  function.rowwise() -= middle;
  result.uv.resize(static_cast<Index>(s->surface->polygons.corner_vertices.size()), 2);
  structure::write_uv_map(*s, function, q, result.uv, execution.workers());
  const double largest = result.uv.cwiseAbs().maxCoeff();
  const double grid = std::exp2(std::ceil(std::log2(largest)) - 24);
  function = (function / grid).array().round() * grid;
  structure::write_uv_map(*s, function, q, result.uv, execution.workers());
  execution.finish();
  return result;
}

}  // namespace holomorph::tiling
