// UVs, forms and seams written to an OpenMesh mesh, where its readers and writers expect them.
#pragma once

#include <Eigen/Core>
#include <OpenMesh/Core/Utils/Property.hh>
#include <span>

#include "openmesh/surface_of_mesh.h"

namespace holomorph::openmesh {

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
