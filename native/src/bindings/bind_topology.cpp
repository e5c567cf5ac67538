#include <vector>

#include "bindings/records.h"
#include "bindings/structure_with_forms.h"
#include "topology/fundamental_domain.h"

namespace holomorph::bindings {
namespace {

py::list loops_of_vertices(const mesh::EdgeEnds& ends, const std::vector<std::vector<mesh::HalfedgeHandle>>& loops) {
  py::list result;
  for (const auto& loop : loops) {
    std::vector<int> vertices;
    for (const auto h : loop) vertices.push_back(mesh::from_vertex(ends, h));
    result.append(copy(vertices));
  }
  return result;
}

// (#forms, #E) values of the natural classes along half-edge 2e.
py::array integer_classes(const Structure& s) {
  const structure::Topology& topology = s.value.topology;
  const int count = topology.families.natural;
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values =
      decltype(values)::Zero(count, static_cast<Eigen::Index>(s.value.surface->edges.size()));
  for (const int e : topology.classes.rows.edges()) {
    for (const auto& [form, value] : topology::forms_between(topology.classes.rows[e], 0, count))
      values(form, e) = value;
  }
  return give_matrix(std::move(values));
}

// The fundamental domain is not kept: it is found again, the same.
struct DomainArrays {
  Array<int> faces;
  std::vector<int> joined, boundary, tree, left_over;  // half-edges of the boundary; edges of the others
};

DomainArrays domain_arrays(const Structure& s) {
  Execution execution(s.threads);
  const mesh::HalfEdges half_edges = mesh::half_edges(*s.value.surface, execution);
  auto domain = topology::fundamental_domain(*s.value.surface, half_edges, execution);
  DomainArrays result;
  for (const int f : domain.face_order) {
    const mesh::HalfedgeHandle h = domain.to_parent_face[f];
    result.joined.push_back(h.is_valid() ? mesh::edge_of(h) : -1);
  }
  for (const auto h : topology::domain_boundary(half_edges, domain)) result.boundary.push_back(h.idx());
  result.tree.resize(domain.vertex_rank.size());
  for (std::size_t v = 0; v < result.tree.size(); ++v) {
    const mesh::HalfedgeHandle h = domain.to_parent_vertex[v];
    result.tree[domain.vertex_rank[v]] = h.is_valid() ? mesh::edge_of(h) : -1;
  }
  result.tree.erase(result.tree.begin());  // the root, the only one without a parent
  result.faces = std::move(domain.face_order);
  result.left_over = std::move(domain.left_over);
  return result;
}

// (faces, edges across which they were joined, half-edges of the boundary, edges of the tree, edges left over)
py::tuple fundamental_domain(const Structure& s) {
  DomainArrays found;
  {
    const py::gil_scoped_release unlocked;
    found = domain_arrays(s);
  }
  return py::make_tuple(give(std::move(found.faces)), give(std::move(found.joined)), give(std::move(found.boundary)),
                        give(std::move(found.tree)), give(std::move(found.left_over)));
}

}  // namespace

void bind_topology(py::class_<Structure, StructurePointer>& type) {
  type.def("homology_basis",
           [](const Structure& s) { return loops_of_vertices(*s.value.surface, s.value.topology.homology_basis); })
      .def("boundary_loops",
           [](const Structure& s) { return loops_of_vertices(*s.value.surface, s.value.topology.boundary.loops); })
      .def("pairing", [](const Structure& s) { return copy(s.value.topology.pairing); })
      .def("intersection_matrix", [](const Structure& s) { return copy(s.value.topology.canonical.intersection); })
      .def("canonical_basis", [](const Structure& s) { return copy(s.value.topology.canonical.cycles); })
      .def("seams", [](const Structure& s) { return copy(s.value.topology.seams); })
      .def("integer_classes", &integer_classes)
      .def("fundamental_domain", &fundamental_domain);
}

}  // namespace holomorph::bindings
