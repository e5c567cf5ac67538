#include "tiling/poles/mirror.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/stars.h"

namespace holomorph::tiling {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kAround = 36;  // vertices around a pole, of which one may be nearer to the plane
constexpr double kNear = 1e-3;       // weight of their distance from the pole against that from the plane

Vector3d position(const mesh::Surface& surface, int vertex) {
  return Vector3d(surface.polygons.vertices[vertex].data());
}

// The corner nearest to a point, of the triangle nearest to it.
int nearest_vertex(const mesh::Surface& surface, const mesh::TriangleTree& tree, const Vector3d& point) {
  const auto& corners = surface.triangles[tree.nearest(point).first];
  return *std::min_element(corners.begin(), corners.end(), [&](int a, int b) {
    return (position(surface, a) - point).squaredNorm() < (position(surface, b) - point).squaredNorm();
  });
}

// The place of least distance in the list that can be a pole beside the others; `vertex` where there is none.
template <class Distance>
int best_place(const PoleBasis& basis, const std::vector<char>& allowed, const std::vector<int>& list,
               const std::vector<int>& poles, int vertex, const Distance& distance) {
  std::vector<int> corners;
  for (const int p : poles) {
    if (p == vertex) continue;
    const auto own = mesh::corners_around(basis.surface(), basis.half_edges(), p);
    corners.insert(corners.end(), own.begin(), own.end());
  }
  std::sort(corners.begin(), corners.end());
  int best = vertex;
  double least = std::numeric_limits<double>::infinity();
  for (const int v : list) {
    if (!(distance(v) < least) || !basis.is_place(v, allowed) ||
        !mesh::are_apart(mesh::corners_around(basis.surface(), basis.half_edges(), v), corners))
      continue;
    best = v;
    least = distance(v);
  }
  return best;
}

}  // namespace

std::optional<Mirror> mirror(const PoleBasis& basis) {
  const mesh::Surface& surface = basis.surface();
  if (surface.intrinsic() || !basis.closed() || basis.form_count() > 0) return std::nullopt;
  const mesh::TriangleTree tree(surface);
  const auto plane = mesh::mirror_plane(surface, tree);
  if (!plane) return std::nullopt;
  Mirror result{*plane, std::vector<int>(surface.vertex_count)};
  std::vector<int> nearest;
  for (int v = 0; v < surface.vertex_count; ++v)
    nearest.push_back(nearest_vertex(surface, tree, plane->image(position(surface, v))));
  // Only vertices that are nearest to each other's reflection are images.
  for (int v = 0; v < surface.vertex_count; ++v) result.image[v] = nearest[nearest[v]] == v ? nearest[v] : -1;
  return result;
}

Mirror mirror_of_poles(const Mirror& on_level, const std::vector<int>& level_poles, const PoleBasis& basis,
                       const std::vector<char>& allowed, std::vector<int>& poles) {
  const mesh::Surface& surface = basis.surface();
  const mesh::MirrorPlane& plane = on_level.plane;
  Mirror result{plane, std::vector<int>(surface.vertex_count, -1)};
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const Index size = orbit_size(level_poles, static_cast<Index>(i), &on_level);
    const Vector3d at = position(surface, poles[i]);
    // A pole that is its own image goes to the plane: of the vertices around it to the nearest one, near the pole where
    // some are equally near.
    if (size == 1) {
      poles[i] = best_place(
          basis, allowed, mesh::vertices_around(basis.half_edges(), poles[i], kAround), poles, poles[i], [&](int v) {
            return std::abs(plane.height(position(surface, v))) + kNear * (position(surface, v) - at).norm();
          });
      result.image[poles[i]] = poles[i];
      // Two poles that are images: the second goes to the vertex nearest to the image of the first, or to one around it
      // that can be a pole.
    } else if (size == 2) {
      const Vector3d image = plane.image(at);
      const auto distance = [&](int v) { return (position(surface, v) - image).norm(); };
      // A search of all vertices: there are only a few poles.
      int nearest = 0;
      for (int v = 1; v < surface.vertex_count; ++v) {
        if (distance(v) < distance(nearest)) nearest = v;
      }
      std::vector<int> list = mesh::vertices_around(basis.half_edges(), nearest, 1);
      list.push_back(poles[i + 1]);
      poles[i + 1] = best_place(basis, allowed, list, poles, poles[i + 1], distance);
      result.image[poles[i]] = poles[i + 1];
      result.image[poles[i + 1]] = poles[i];
    }
  }
  return result;
}

Index orbit_size(const std::vector<int>& poles, Index i, const Mirror* mirror) {
  const auto at = static_cast<std::size_t>(i);
  // Images follow each other in the list: 2 at the first of the two, 0 at the second.
  if (!mirror || mirror->image[poles[at]] == poles[at]) return 1;
  return at + 1 < poles.size() && mirror->image[poles[at]] == poles[at + 1] ? 2 : 0;
}

std::vector<int> with_images(std::vector<int> vertices, const Mirror* mirror) {
  if (!mirror) return vertices;
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (const int image = mirror->image[vertices[i]]; image >= 0 && image != vertices[i]) vertices.push_back(image);
  }
  return vertices;
}

MatrixXcd symmetric_residues(const std::vector<int>& poles, const Mirror& mirror) {
  const auto count = static_cast<Index>(poles.size());
  MatrixXcd real(count, 0), imaginary(count, 0);
  for (Index i = 0; i < count; ++i) {
    const Index size = orbit_size(poles, i, &mirror);
    if (size == 0) continue;
    real.conservativeResize(Eigen::NoChange, real.cols() + 1);
    real.rightCols(1).setZero();
    // Real parts of a pair are equal, imaginary parts opposite. A pole on the plane has a real residue.
    real.col(real.cols() - 1).segment(i, size).setConstant(1 / static_cast<double>(size));
    if (size == 1) continue;
    imaginary.conservativeResize(Eigen::NoChange, imaginary.cols() + 1);
    imaginary.rightCols(1).setZero();
    imaginary.col(imaginary.cols() - 1).segment(i, 2) << Complex(0, 1), Complex(0, -1);
  }
  const Index free = std::max<Index>(0, real.cols() - 1);  // the last orbit takes the rest of the real parts
  MatrixXcd all(count, free + imaginary.cols());
  all << real.leftCols(free).colwise() - real.rightCols(1).rowwise().sum(), imaginary;
  return all;
}

Index first_to_last(MeromorphicForm& form, const Mirror* mirror) {
  const Index size = orbit_size(form.poles, 0, mirror);
  std::rotate(form.poles.begin(), form.poles.begin() + size, form.poles.end());
  std::rotate(form.residues.begin(), form.residues.begin() + size, form.residues.end());
  return size;
}

MeromorphicForm without_last(MeromorphicForm form, Index size, bool closed) {
  const Index k = form.residues.size() - size;
  const Complex last = form.residues.tail(size).sum();
  form.poles.resize(k);
  form.residues.conservativeResize(k);
  // On a closed surface residues sum to 0: what is removed is shared by the rest.
  if (closed) form.residues.array() += last / static_cast<double>(k);
  return form;
}

MeromorphicForm joined(MeromorphicForm form, int vertex, Complex residue, bool closed, const Mirror* mirror) {
  const Index k = form.residues.size();
  const bool pair = mirror && !mirror->is_on_plane(vertex);
  const Complex sum = pair ? 2 * residue.real() : residue;
  if (closed && k > 0) form.residues.array() -= sum / static_cast<double>(k);
  form.poles.push_back(vertex);
  if (pair) form.poles.push_back(mirror->image[vertex]);
  form.residues.conservativeResize(std::ssize(form.poles));
  form.residues[k] = closed && k == 0 ? 0 : residue;
  if (pair) form.residues[k + 1] = std::conj(residue);
  return form;
}

}  // namespace holomorph::tiling
