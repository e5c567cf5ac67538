#include "forms/certificates.h"

#include <array>
#include <type_traits>

#include "forms/gram_matrices.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;
using mesh::sign;
using mesh::to_vertex;

template <int N>
using Row = Eigen::Matrix<double, 1, N>;

// The functions of all forms at one vertex.
template <int N>
Eigen::Map<const Row<N>> at_vertex(const ClosedForms& forms, int v) {
  const auto n = forms.functions.cols();
  return {forms.functions.data() + v * n, n};
}

// Adds `factor` times the values of all forms along h. N is their number where it is known when compiling, which is
// several times faster.
template <int N>
void add_along(const HalfEdges& half_edges, const ClosedForms& forms, HalfedgeHandle h, double factor, Row<N>& sum) {
  const int head = to_vertex(half_edges, h), tail = mesh::from_vertex(half_edges, h);
  sum += factor * (at_vertex<N>(forms, head) - at_vertex<N>(forms, tail));
  const int first = forms.first, count = static_cast<int>(sum.size());
  for (const auto& [i, value] : topology::forms_between(forms.classes.rows[edge_of(h)], first, first + count))
    sum[i - first] += factor * sign(h) * value;
}

template <int N>
using Maxima = std::array<Row<N>, 2>;  // per form: largest |sum|, and largest scale that it is relative to

// Faces: |sum of h around the face| against the largest value. Each is visited at its half-edge of lowest number, since
// half-edges with near numbers are near in memory.
template <int N>
void measure_faces(const HalfEdges& half_edges, const ClosedForms& forms, int begin, int end, Maxima<N>& maxima) {
  const auto n = forms.functions.cols();
  Row<N> sum(n), value(n);
  for (int first = begin; first < end; ++first) {
    HalfedgeHandle h(first);
    if (half_edges.is_boundary(h) || !mesh::is_first_of_face(half_edges, h)) continue;
    sum.setZero();
    for (int i = 0; i < 3; ++i, h = next(half_edges, h)) {
      value.setZero();
      add_along<N>(half_edges, forms, h, 1.0, value);
      sum += value;
      maxima[1] = maxima[1].cwiseMax(value.cwiseAbs());
    }
    maxima[0] = maxima[0].cwiseMax(sum.cwiseAbs());
  }
}

// Vertices: |d* h| = |sum of k h over the half-edges that leave| against the sum of |k h|.
template <int N>
void measure_vertices(const HalfEdges& half_edges, std::span<const double> weights, const ClosedForms& forms,
                      int natural, const std::vector<char>& is_fixed, int begin, int end, Maxima<N>& maxima) {
  const auto n = forms.functions.cols();
  Row<N> sum(n), size(n), value(n);
  for (int v = begin; v < end; ++v) {
    sum.setZero();
    size.setZero();
    const HalfedgeHandle start = half_edges.halfedge_handle(mesh::VertexHandle(v));
    HalfedgeHandle h = start;
    // Half-edges without a face are linked along the boundary, so this walk also closes at a boundary vertex.
    do {
      value.setZero();
      add_along<N>(half_edges, forms, h, weights[edge_of(h)], value);
      sum += value;
      size += value.cwiseAbs();
      h = next(half_edges, opposite(h));
    } while (h != start);
    // Dirichlet forms are prescribed here: there is no equation to be measured.
    if (is_fixed[v]) {
      sum.tail(n - natural).setZero();
      size.tail(n - natural).setZero();
    }
    maxima[0] = maxima[0].cwiseMax(sum.cwiseAbs());
    maxima[1] = maxima[1].cwiseMax(size);
  }
}

template <int N, class Measure>
double relative_maximum(std::size_t elements, Eigen::Index forms, Execution& execution, double from, double to,
                        Measure measure) {
  const Row<N> zero = Row<N>::Zero(forms);
  std::array<Maxima<N>, kBatch> slots;
  Maxima<N> total{zero, zero};
  for_blocks(
      elements, execution, from, to,
      [&](int slot, int begin, int end) {
        slots[slot] = {zero, zero};
        measure(begin, end, slots[slot]);
      },
      [&](int slot) {
        for (int i = 0; i < 2; ++i) total[i] = total[i].cwiseMax(slots[slot][i]);
      });
  // One quotient for each form: the error of a small form is not hidden by a large one.
  return (total[0].array() / total[1].array()).maxCoeff();
}

// A triangle adds cot / 2 h^2 for each side, cot that of the angle opposite.
template <int N>
Eigen::VectorXd energies_of(const mesh::Surface& surface, const ClosedForms& forms, Execution& execution) {
  const auto n = forms.functions.cols();
  const int first = forms.first, count = static_cast<int>(n);
  const auto add_side = [&](int e, double cotangent, Row<N>& value, Row<N>& sum) {
    const auto [tail, head] = surface.edges[e];
    value = at_vertex<N>(forms, head) - at_vertex<N>(forms, tail);
    for (const auto& [i, integer] : topology::forms_between(forms.classes.rows[e], first, first + count))
      value[i - first] += integer;
    sum += 0.5 * cotangent * value.cwiseAbs2();
  };
  std::array<Row<N>, kBatch> slots;
  Row<N> total = Row<N>::Zero(n);
  for_blocks(
      surface.triangle_edges.size(), execution, 0.0, 1.0,
      [&](int slot, int begin, int end) {
        Row<N> value(n), sum = Row<N>::Zero(n);
        for (int t = begin; t < end; ++t) {
          const auto [i, j, k] = surface.triangle_edges[t];
          const double a = surface.edge_lengths[i], b = surface.edge_lengths[j], c = surface.edge_lengths[k],
                       area = mesh::triangle_area(a, b, c);
          add_side(i, mesh::cotangent(a, b, c, area), value, sum);
          add_side(j, mesh::cotangent(b, c, a, area), value, sum);
          add_side(k, mesh::cotangent(c, a, b, area), value, sum);
        }
        slots[slot] = sum;
      },
      [&](int slot) { total += slots[slot]; });
  return total.transpose();
}

template <int N>
Residuals residuals_of(const HalfEdges& half_edges, std::span<const double> weights, const ClosedForms& forms,
                       Execution& execution, int natural, const std::vector<char>& is_fixed) {
  const auto n = forms.functions.cols();
  const auto faces = [&](int begin, int end, Maxima<N>& maxima) {
    measure_faces<N>(half_edges, forms, begin, end, maxima);
  };
  const auto vertices = [&](int begin, int end, Maxima<N>& maxima) {
    measure_vertices<N>(half_edges, weights, forms, natural, is_fixed, begin, end, maxima);
  };
  return {relative_maximum<N>(half_edges.n_halfedges(), n, execution, 0.0, 0.5, faces),
          relative_maximum<N>(half_edges.n_vertices(), n, execution, 0.5, 1.0, vertices)};
}

// compute(N) with the number of forms, where it is that of a surface with few handles; else with Eigen::Dynamic.
template <class Compute>
auto with_count(Eigen::Index count, const Compute& compute) {
  switch (count) {
    case 2:
      return compute(std::integral_constant<int, 2>());
    case 4:
      return compute(std::integral_constant<int, 4>());
    case 6:
      return compute(std::integral_constant<int, 6>());
    default:
      return compute(std::integral_constant<int, Eigen::Dynamic>());
  }
}

}  // namespace

Eigen::VectorXd energies(const mesh::Surface& surface, const ClosedForms& forms, Execution& execution) {
  return with_count(forms.functions.cols(), [&](auto n) { return energies_of<n>(surface, forms, execution); });
}

Eigen::VectorXd wedges(const HalfEdges& half_edges, const ClosedForms& forms, const Eigen::VectorXd& w,
                       Execution& execution) {
  const auto n = forms.functions.cols();
  std::array<Eigen::RowVectorXd, kBatch> slots;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n);
  for_blocks(
      half_edges.n_faces(), execution, 0.0, 1.0,
      [&](int slot, int begin, int end) {
        slots[slot] = Eigen::RowVectorXd::Zero(n);
        for (int f = begin; f < end; ++f) {
          // (h(e0) w(e1) - h(e1) w(e0)) / 2: exact, because both forms are constant on the face
          // (docs/method/conventions.md).
          const HalfedgeHandle h0 = half_edges.halfedge_handle(mesh::FaceHandle(f)), h1 = next(half_edges, h0);
          add_along<Eigen::Dynamic>(half_edges, forms, h0, 0.5 * sign(h1) * w[edge_of(h1)], slots[slot]);
          add_along<Eigen::Dynamic>(half_edges, forms, h1, -0.5 * sign(h0) * w[edge_of(h0)], slots[slot]);
        }
      },
      [&](int slot) { sum += slots[slot]; });
  return sum.transpose();
}

Residuals residuals(const HalfEdges& half_edges, std::span<const double> weights, const ClosedForms& forms,
                    Execution& execution, int natural, const std::vector<int>& fixed) {
  std::vector<char> is_fixed(half_edges.n_vertices(), 0);
  for (const int v : fixed) is_fixed[v] = 1;
  return with_count(forms.functions.cols(),
                    [&](auto n) { return residuals_of<n>(half_edges, weights, forms, execution, natural, is_fixed); });
}

}  // namespace holomorph::forms
