#include "flat/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "mesh/cut_open.h"
#include "mesh/half_edges.h"
#include "mesh/hard_edges.h"
#include "mesh/hidden_cut.h"
#include "mesh/make_surface.h"

namespace holomorph::flat {
namespace {

constexpr double kSpeck = 0.01;        // part of the area: less than that beside a piece does not divide a part
constexpr double kWorth = 0.03;        // part of the area, from which on a piece is looked at by itself
constexpr std::size_t kEnds = 2;       // the longest boundary loops of a tube
constexpr double kCoarseDigits = 1e9;  // of lengths over the longest edge: loops that differ by less are equally long

struct Window {
  std::vector<int> vertices;  // around the hole, which lies on the left
  double length = 0;
};

// The components that cuts leave, with indices of the surface as it was given.
std::vector<mesh::Component> parts(const mesh::OrientedSurface& oriented, const std::vector<char>& is_cut,
                                   Execution& execution) {
  const auto open = mesh::cut_open(oriented.surface, is_cut, execution);
  std::vector<mesh::Component> result = mesh::components(open.surface, execution);
  for (mesh::Component& part : result) {
    for (int& v : part.vertex_index) v = open.vertex_index[v];
    for (int& c : part.corner_index) c = oriented.corner_index.empty() ? c : oriented.corner_index[c];
  }
  return result;
}

}  // namespace

std::vector<int> names_of_pieces(const mesh::Surface& surface, const std::vector<char>& is_hard) {
  std::vector<int> names = mesh::parts(surface, is_hard);
  std::vector<double> areas(1 + *std::ranges::max_element(names), 0.0);
  const auto normals = mesh::triangle_normals(surface);
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const auto& [x, y, z] = normals[t];
    areas[names[surface.triangle_faces[t]]] += std::sqrt(x * x + y * y + z * z);
  }
  double all = 0;
  for (const double area : areas) all += area;
  const bool is_one = *std::ranges::max_element(areas) > (1 - kSpeck) * all;
  for (int& name : names) name = is_one ? 0 : areas[name] >= kWorth * all ? name : kRest;
  return names;
}

std::vector<mesh::Component> cut_apart(const mesh::Surface& surface, const std::vector<int>& names,
                                       Execution& execution) {
  const mesh::OrientedSurface oriented = mesh::in_one_orientation(surface, execution);
  return parts(oriented, mesh::edges_between(oriented.surface, names), execution);
}

CutInHiding cut_in_hiding(const mesh::Surface& surface, const std::optional<std::array<double, 3>>& up,
                          Execution& execution) {
  const mesh::OrientedSurface oriented = mesh::in_one_orientation(surface, execution);
  const mesh::HiddenCut cut = mesh::hidden_cut(oriented.surface, up, execution);
  return {parts(oriented, cut.is_cut, execution), cut.seen};
}

mesh::Surface without_windows(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  double longest = 0;
  std::vector<Window> loops;
  for (const auto& loop : mesh::boundary_loops(surface, half_edges).loops) {
    for (const auto h : loop) longest = std::max(longest, surface.edge_lengths[mesh::edge_of(h)]);
  }
  for (const auto& loop : mesh::boundary_loops(surface, half_edges).loops) {
    Window& made = loops.emplace_back();
    for (const auto h : loop) {
      made.vertices.push_back(mesh::from_vertex(half_edges, h));
      made.length += std::nearbyint(surface.edge_lengths[mesh::edge_of(h)] / longest * kCoarseDigits);
    }
  }
  if (loops.size() <= kEnds) return surface;
  const auto lowest = [](const Window& loop) { return *std::ranges::min_element(loop.vertices); };
  std::ranges::sort(loops, [&](const Window& a, const Window& b) {
    return std::pair(-a.length, lowest(a)) < std::pair(-b.length, lowest(b));
  });
  mesh::Polygons polygons = surface.polygons;
  for (std::size_t k = kEnds; k < loops.size(); ++k) {
    polygons.corner_vertices.insert(polygons.corner_vertices.end(), loops[k].vertices.begin(), loops[k].vertices.end());
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  }
  return mesh::make_surface(std::move(polygons), execution);
}

double turn_between(const mesh::Surface& surface, const uv::UvArray& one, const uv::UvArray& other) {
  std::vector<double> areas;
  std::vector<Complex>
      quarters;  // four times the best rotation of each triangle: squares are alike after a quarter turn
  Complex mean = 0;
  for (const mesh::Triple& corners : surface.triangle_corners) {
    std::array<Complex, 3> a, b;
    for (int i = 0; i < 3; ++i) {
      a[i] = {one(corners[i], 0), one(corners[i], 1)};
      b[i] = {other(corners[i], 0), other(corners[i], 1)};
    }
    const Complex centre = (a[0] + a[1] + a[2]) / 3.0;
    Complex sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::conj(a[i] - centre) * b[i];
    areas.push_back(std::abs((std::conj(b[1] - b[0]) * (b[2] - b[0])).imag()));
    quarters.push_back(std::polar(1.0, 4 * std::arg(sum)));
    mean += areas.back() * quarters.back();
  }
  double all = 0, off = 0;
  for (std::size_t t = 0; t < areas.size(); ++t) {
    all += areas[t];
    off += areas[t] * std::abs(std::arg(quarters[t] * std::conj(mean))) / 4;
  }
  return all > 0 ? off / all : 0;
}

}  // namespace holomorph::flat
