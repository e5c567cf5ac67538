// Handles of the elements of a mesh, with the names of OpenMesh's.
#pragma once

#include <compare>

namespace holomorph::mesh {

/// The index of an element; -1 names none. Each kind of element has a type of its own, so that no handle of one is
/// taken for one of another.
template <class Element>
class Handle {
 public:
  Handle() = default;
  explicit Handle(int index) : index_(index) {}

  int idx() const { return index_; }
  bool is_valid() const { return index_ >= 0; }
  auto operator<=>(const Handle&) const = default;

 private:
  int index_ = -1;
};

using VertexHandle = Handle<struct Vertex>;
using HalfedgeHandle = Handle<struct Halfedge>;
using EdgeHandle = Handle<struct Edge>;
using FaceHandle = Handle<struct Face>;

}  // namespace holomorph::mesh
