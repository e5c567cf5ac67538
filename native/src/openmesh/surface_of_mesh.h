// A surface from an OpenMesh mesh, triangles or polygons, and which element of the mesh each of its elements is.
#pragma once

#include <Eigen/Core>
#include <OpenMesh/Core/Mesh/Handles.hh>
#include <OpenMesh/Core/Utils/Property.hh>
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::openmesh {

/// The surface's elements are the mesh's in their order, without what is deleted and without isolated vertices. So the
/// lower vertex of an edge is that of the lower handle.
struct SurfaceOfMesh {
  std::shared_ptr<const mesh::Surface> surface;
  std::vector<OpenMesh::VertexHandle> vertices;   ///< #V
  std::vector<OpenMesh::FaceHandle> faces;        ///< #F
  std::vector<OpenMesh::HalfedgeHandle> corners;  ///< #C inside the corner's face, ends at the corner: where OpenMesh
                                                  ///< keeps the texture coordinate of a corner
  std::vector<OpenMesh::HalfedgeHandle> edges;  ///< #polygon edges, from the lower to the higher vertex; the diagonals
                                                ///< of polygons, which come after, are not edges of the mesh
};

/// @param mesh any TriMesh_ArrayKernelT or PolyMesh_ArrayKernelT, points of three floats or doubles. Faces stay
/// polygons; their corners begin with halfedge_handle(face), as in fv_range
/// @throws InvalidMesh for invalid links or polygons (see mesh::make_surface), and for two edges with the same ends.
/// Where elements are left out, its message says that its numbers are the surface's. Cost: linear.
template <class Mesh>
SurfaceOfMesh to_surface(const Mesh& mesh, Execution& execution);

/// Returns the connected components, each with the handles of the whole mesh. A conformal structure is computed of one
/// component.
std::vector<SurfaceOfMesh> components(const SurfaceOfMesh& whole, Execution& execution);

/// An element is deleted where its status says so; a mesh without status has no deleted elements.
template <class Mesh>
bool is_deleted(const Mesh& mesh, OpenMesh::VertexHandle v) {
  return mesh.has_vertex_status() && mesh.status(v).deleted();
}
template <class Mesh>
bool is_deleted(const Mesh& mesh, OpenMesh::FaceHandle f) {
  return mesh.has_face_status() && mesh.status(f).deleted();
}

namespace detail {

/// The surface of the handles gathered so far. @param corner_vertices the mesh's. @param left_out whether elements are
SurfaceOfMesh finish(SurfaceOfMesh part, mesh::Polygons polygons, bool left_out, Execution& execution);

/// Appends the corners of a face. @throws InvalidMesh for links that lead nowhere or to a deleted vertex
template <class Mesh>
void append_face(const Mesh& mesh, OpenMesh::FaceHandle f, SurfaceOfMesh& part, mesh::Polygons& polygons) {
  const OpenMesh::HalfedgeHandle first = mesh.halfedge_handle(f);
  OpenMesh::HalfedgeHandle h = first;
  do {
    const bool linked = h.is_valid() && mesh.face_handle(h) == f && part.corners.size() < mesh.n_halfedges();
    if (!linked) throw InvalidMesh("the half-edges of face " + std::to_string(f.idx()) + " do not form a closed loop");
    const OpenMesh::VertexHandle v = mesh.to_vertex_handle(h);
    if (is_deleted(mesh, v)) {
      throw InvalidMesh("face " + std::to_string(f.idx()) + " has the deleted vertex " + std::to_string(v.idx()));
    }
    part.corners.push_back(h);
    polygons.corner_vertices.push_back(v.idx());
    h = mesh.next_halfedge_handle(h);
  } while (h != first);
  part.faces.push_back(f);
  polygons.face_offsets.push_back(static_cast<int>(part.corners.size()));
}

}  // namespace detail

template <class Mesh>
SurfaceOfMesh to_surface(const Mesh& mesh, Execution& execution) {
  static_assert(OpenMesh::vector_traits<typename Mesh::Point>::size_ == 3, "points need three coordinates");
  SurfaceOfMesh part;
  mesh::Polygons polygons;
  polygons.face_offsets.push_back(0);
  for (int f = 0; f < static_cast<int>(mesh.n_faces()); ++f) {
    if (!is_deleted(mesh, OpenMesh::FaceHandle(f))) detail::append_face(mesh, OpenMesh::FaceHandle(f), part, polygons);
  }
  std::vector<int> number(mesh.n_vertices(), -1);
  for (const int v : polygons.corner_vertices) number[v] = 0;
  for (int v = 0; v < static_cast<int>(number.size()); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(part.vertices.size());
    part.vertices.emplace_back(v);
    const auto& point = mesh.point(OpenMesh::VertexHandle(v));
    polygons.vertices.push_back(
        {static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])});
  }
  for (int& v : polygons.corner_vertices) v = number[v];
  const bool left_out = part.vertices.size() < mesh.n_vertices() || part.faces.size() < mesh.n_faces();
  return detail::finish(std::move(part), std::move(polygons), left_out, execution);
}

// UVs, forms and seams written to an OpenMesh mesh, where its readers and writers expect them.

namespace detail {
/// @throws InvalidMesh: "12 UVs do not fit a surface with 24 corners"
void require_count(std::ptrdiff_t given, const char* what, std::size_t count, const char* elements);
/// @throws InvalidMesh naming an edge that is none of the mesh
void require_edges(std::span<const int> edges, const SurfaceOfMesh& part);
[[noreturn]] void throw_changed(OpenMesh::HalfedgeHandle h, OpenMesh::VertexHandle v);
}  // namespace detail

/// @throws InvalidMesh where a corner's half-edge is gone or ends elsewhere: the mesh was changed since
template <class Mesh>
void require_unchanged(const Mesh& mesh, const SurfaceOfMesh& part) {
  for (std::size_t c = 0; c < part.corners.size(); ++c) {
    const auto h = part.corners[c];
    const auto v = part.vertices[part.surface->polygons.corner_vertices[c]];
    const bool there = h.idx() < static_cast<int>(mesh.n_halfedges()) && mesh.face_handle(h).is_valid() &&
                       mesh.to_vertex_handle(h) == v && !is_deleted(mesh, mesh.face_handle(h));
    if (!there) detail::throw_changed(h, v);
  }
}

using UvRef = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>;

/// UVs as texture coordinates of half-edges, rounded to the mesh's type; these are requested where the mesh has none.
/// OpenMesh's OBJ and OM writers store them with IO::Options::FaceTexCoord. Other components and half-edges of the
/// boundary keep what they have.
/// @param uv #C x 2, of the surface's corners
/// @throws InvalidMesh if the shapes do not fit or the mesh has changed; nothing is written then
template <class Mesh>
void write_uv(Mesh& mesh, const SurfaceOfMesh& part, const UvRef& uv) {
  using TexCoord = typename Mesh::TexCoord2D;
  using Number = typename OpenMesh::vector_traits<TexCoord>::value_type;
  detail::require_count(uv.rows(), "UVs", part.corners.size(), "corners");
  require_unchanged(mesh, part);
  if (!mesh.has_halfedge_texcoords2D()) mesh.request_halfedge_texcoords2D();
  for (std::size_t c = 0; c < part.corners.size(); ++c) {
    const auto row = uv.row(static_cast<Eigen::Index>(c));
    mesh.set_texcoord2D(part.corners[c], TexCoord(static_cast<Number>(row[0]), static_cast<Number>(row[1])));
  }
}

/// A one-form as a property of the mesh's edges: its integral along half-edge 0 of each, in the unit of the form. The
/// surface's value is meant from the lower to the higher vertex, so that it changes its sign where half-edge 0 runs the
/// other way. Diagonals of polygons have no edge; closedness gives the values there.
/// @param values #E of the surface, real or complex: a row or a column
/// @param property added to the mesh by the caller, EPropHandleT<double> or EPropHandleT<std::complex<double>>
/// @throws InvalidMesh if the shapes do not fit or the mesh has changed; nothing is written then
template <class Mesh, class Values, class Number>
void write_form(Mesh& mesh, const SurfaceOfMesh& part, const Eigen::MatrixBase<Values>& values,
                OpenMesh::EPropHandleT<Number> property) {
  static_assert(Values::IsVectorAtCompileTime, "the values of one form are a row or a column");
  detail::require_count(values.size(), "values", part.surface->edges.size(), "edges");
  require_unchanged(mesh, part);
  for (std::size_t e = 0; e < part.edges.size(); ++e) {
    const auto h = part.edges[e];
    const Number value = values.derived().coeff(static_cast<Eigen::Index>(e));
    mesh.property(property, mesh.edge_handle(h)) = mesh.halfedge_handle(mesh.edge_handle(h), 0) == h ? value : -value;
  }
}

/// Sets the feature bit in the status of edges, which is requested where the mesh has none; it is never cleared.
/// @param edges of the surface, polygon edges: Topology::seams
/// @throws InvalidMesh for an edge that is none of the mesh, or if the mesh has changed; nothing is written then
template <class Mesh>
void mark_seams(Mesh& mesh, const SurfaceOfMesh& part, std::span<const int> edges) {
  detail::require_edges(edges, part);
  require_unchanged(mesh, part);
  if (!mesh.has_edge_status()) mesh.request_edge_status();
  for (const int e : edges) mesh.status(mesh.edge_handle(part.edges[e])).set_feature(true);
}

}  // namespace holomorph::openmesh
