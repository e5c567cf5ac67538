#include "tiles/cells.h"

#include <algorithm>
#include <cmath>

namespace holomorph::tiles {
namespace {

constexpr double kSide = 10;  // operations: of a side of a piece in a step

// Joins the pieces of each tile across sides that are not walls, and reads off the outlines.
class Joining {
 public:
  explicit Joining(const Pieces& pieces) : p_(pieces), is_wall_(pieces.is_wall) {
    const auto sides = static_cast<int>(p_.side_nodes.size());
    piece_.resize(sides);
    for (int f = 0; f < count(); ++f) {
      for (int s = p_.offsets[f]; s < p_.offsets[f + 1]; ++s) piece_[s] = f;
    }
    // At most two sides have the same segment: the pieces on both sides of it.
    std::vector<int> first(is_wall_.size(), kNone);
    twin_.assign(sides, kNone);
    for (int s = 0; s < sides; ++s) {
      int& other = first[p_.side_segments[s]];
      if (other == kNone) {
        other = s;
      } else {
        twin_[s] = other;
        twin_[other] = s;
      }
    }
  }

  Cells run(Execution& execution) {
    const auto step = [&](const auto& work) {
      execution.report(1);
      Execution::count(kSide * static_cast<double>(twin_.size()));
      return work();
    };
    step([&] { open_flat_pieces(); });
    if (p_.group.order() > 1) step([&] { open_loose_ends(); });
    step([&] { find_cells(); });
    step([&] { find_what_is_no_disk(); });
    step([&] { find_what_is_not_simple(); });
    step([&] { part_broken_cells(); });
    return step([&] { return outlines(); });
  }

 private:
  int count() const { return static_cast<int>(p_.tiles.size()); }
  int following(int side) const {
    return side + 1 < p_.offsets[piece_[side] + 1] ? side + 1 : p_.offsets[piece_[side]];
  }
  bool is_wall(int side) const { return is_wall_[p_.side_segments[side]]; }
  /// The turn across a side that is no wall, to the piece beyond.
  int across(int side) const { return p_.side_turns[side] - p_.side_turns[twin_[side]]; }
  /// The next wall around the cell. `turn`: from the chart of its piece to that of the cell
  int next_wall(int side, int& turn) const {
    int next = following(side);
    while (!is_wall(next)) {
      turn -= across(next);
      next = following(twin_[next]);
    }
    return next;
  }

  // A piece without area that lies on a line belongs to no tile: it is joined to a neighbour.
  void open_flat_pieces() {
    for (int f = 0; f < count(); ++f) {
      const int begin = p_.offsets[f], end = p_.offsets[f + 1];
      int walls = 0, open = kNone;
      for (int s = begin; s < end; ++s) {
        walls += is_wall(s);
        if (open == kNone && twin_[s] != kNone && p_.poles[piece_[twin_[s]]] == kNone) open = s;
      }
      if (walls == end - begin && open != kNone && is_flat(f)) is_wall_[p_.side_segments[open]] = 0;
    }
  }

  bool is_flat(int f) const {
    const Point& first = p_.side_points[p_.offsets[f]];
    bool flat[2] = {true, true};
    for (int s = p_.offsets[f]; s < p_.offsets[f + 1]; ++s) {
      for (int x = 0; x < 2; ++x) flat[x] = flat[x] && p_.side_points[s][x] == first[x];
    }
    return flat[0] || flat[1];
  }

  // A side of a tile that is folded about a cone in its middle has the tile on both sides, and ends at the cone: no
  // tile needs it.
  void open_loose_ends() {
    std::vector<int> walls(p_.nodes.triangles.size(), 0);  // at each node
    std::vector<std::int64_t> ends(walls.size(), 0);       // the sum of their sides
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (!is_wall(s) || (twin_[s] != kNone && twin_[s] < s)) continue;
      for (const int node : {p_.side_nodes[s], p_.side_nodes[following(s)]}) {
        ++walls[node];
        ends[node] += s;
      }
    }
    for (std::size_t start = 0; start < walls.size(); ++start) {
      for (auto node = static_cast<int>(start); walls[node] == 1;) {
        const int s = static_cast<int>(ends[node]), from = p_.side_nodes[s], to = p_.side_nodes[following(s)];
        is_wall_[p_.side_segments[s]] = 0;
        walls[node] = 0;
        node = node == from ? to : from;
        --walls[node];
        ends[node] -= s;
      }
    }
  }

  // cell_: #P the first piece of each piece's cell
  void find_cells() {
    cell_.assign(count(), kNone);
    turn_.assign(count(), 0);
    for (int f = 0; f < count(); ++f) {
      if (cell_[f] != kNone) continue;
      cell_[f] = f;
      std::vector<int> pending{f};
      for (std::size_t i = 0; i < pending.size(); ++i) {
        const int g = pending[i];
        for (int s = p_.offsets[g]; s < p_.offsets[g + 1]; ++s) {
          if (is_wall(s) || cell_[piece_[twin_[s]]] != kNone) continue;
          const int h = piece_[twin_[s]];
          cell_[h] = f;
          turn_[h] = p_.group.reduced(turn_[g] - across(s));
          pending.push_back(h);
        }
      }
    }
  }

  // An open cell is a disk if and only if its Euler characteristic is 1: its pieces, less the sides between them, plus
  // the nodes inside.
  void find_what_is_no_disk() {
    std::vector<int> euler(count(), 0);
    std::vector<char> is_known(p_.nodes.triangles.size(), 0);  // nodes on walls, and those that are counted
    for (int f = 0; f < count(); ++f) ++euler[cell_[f]];
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (is_wall(s)) {
        is_known[p_.side_nodes[s]] = is_known[p_.side_nodes[following(s)]] = 1;
      } else if (twin_[s] > s) {
        --euler[cell_[piece_[s]]];
      }
    }
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (is_known[p_.side_nodes[s]]) continue;
      is_known[p_.side_nodes[s]] = 1;
      ++euler[cell_[piece_[s]]];
    }
    is_broken_.resize(count());
    for (int f = 0; f < count(); ++f) is_broken_[f] = euler[cell_[f]] != 1;
  }

  // Walks around the outline of each cell: it is not simple if it meets a node twice, or has fewer than three corners.
  void find_what_is_not_simple() {
    std::vector<int> seen(p_.nodes.triangles.size(), kNone);
    std::vector<char> visited(twin_.size(), 0);
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (visited[s] || !is_wall(s) || is_broken_[cell_[piece_[s]]]) continue;
      int length = 0, at = s, turn = 0;
      bool is_simple = true;
      do {
        const int node = p_.side_nodes[at];
        is_simple = is_simple && seen[node] != s;
        seen[node] = s;
        visited[at] = 1;
        ++length;
        at = next_wall(at, turn);
      } while (at != s);
      if (!is_simple || length < 3) is_broken_[cell_[piece_[s]]] = 1;
    }
    for (int f = 0; f < count(); ++f) is_broken_[f] |= is_broken_[cell_[f]];
  }

  // Cuts each broken cell into a few disks. A disk grows by pieces as long as it stays a disk, then the next one
  // begins.
  void part_broken_cells() {
    std::vector<int> region(count(), kNone), touched(p_.nodes.triangles.size(), kNone);
    for (int f = 0; f < count(); ++f) {
      if (!is_broken_[f] || region[f] != kNone) continue;
      std::vector<int> pending{f};
      region[f] = f;
      for (std::size_t i = 0; i < pending.size(); ++i) {
        const int g = pending[i];
        if (g != f && (region[g] != kNone || !fits(g, f, region, touched))) continue;
        region[g] = f;
        for (int s = p_.offsets[g]; s < p_.offsets[g + 1]; ++s) {
          touched[p_.side_nodes[s]] = f;
          if (!is_wall(s) && region[piece_[twin_[s]]] == kNone) pending.push_back(piece_[twin_[s]]);
        }
      }
    }
    for (int s = 0; s < std::ssize(twin_); ++s) {
      // The sides between two of these disks are walls from now on.
      const bool is_between =
          is_broken_[piece_[s]] && twin_[s] != kNone && region[piece_[s]] != region[piece_[twin_[s]]];
      if (is_between) is_wall_[p_.side_segments[s]] = 1;
    }
    for (int f = 0; f < count(); ++f) {
      if (is_broken_[f]) cell_[f] = region[f];
    }
  }

  // Whether a disk and a piece together are a disk: they share one connected part of the piece's outline, and no other
  // node.
  bool fits(int piece, int disk, const std::vector<int>& region, const std::vector<int>& touched) const {
    int nodes = 0, sides = 0, parts = 0;
    const auto is_shared = [&](int s) { return !is_wall(s) && region[piece_[twin_[s]]] == disk; };
    for (int s = p_.offsets[piece]; s < p_.offsets[piece + 1]; ++s) {
      nodes += touched[p_.side_nodes[s]] == disk;
      sides += is_shared(s);
      parts += is_shared(s) && !is_shared(following(s));
    }
    return parts == 1 && nodes == sides + 1;
  }

  Cells outlines() const {
    Cells cells;
    std::vector<char> visited(twin_.size(), 0);
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (visited[s] || !is_wall(s)) continue;
      const int cell = cell_[piece_[s]];
      const auto& tile = p_.tiles[cell];
      const int start = turn_[piece_[s]] - turn_[cell];
      int at = s, turn = start;
      do {
        visited[at] = 1;
        cells.corner_vertices.push_back(p_.side_nodes[at]);
        cells.corner_points.push_back(point(at, turn, cell));
        at = next_wall(at, turn);
      } while (at != s);
      cells.offsets.push_back(static_cast<int>(cells.corner_vertices.size()));
      cells.tiles.push_back(tile);
      cells.poles.push_back(p_.poles[cell]);
      cells.is_whole.push_back(!is_broken_[cell]);
      cells.turns.push_back(p_.group.reduced(turn - start));
    }
    number_vertices(cells);
    return cells;
  }

  // The start of a side in the chart of a cell. That of its piece is turned against it, and between them lie whole
  // tiles: the middle of the tile is the same in both.
  Point point(int side, int turn, int cell) const {
    const Point& at = p_.side_points[side];
    if (p_.poles[cell] != kNone) return at;
    const auto middle = [&](int piece) {
      const auto& [column, row] = p_.tiles[piece];
      return Eigen::Vector2d(static_cast<double>(column) + p_.middle[0], static_cast<double>(row) + p_.middle[1]);
    };
    const Eigen::Matrix2d& power = p_.group.power(turn);
    const Eigen::Vector2d moved = power * Eigen::Vector2d(at[0], at[1]) + (middle(cell) - power * middle(piece_[side]));
    return {moved[0], moved[1]};
  }

  // Numbers the nodes at walls. One with two walls lies on a side of cells, and may be left out.
  void number_vertices(Cells& cells) const {
    std::vector<int> walls(p_.nodes.triangles.size(), 0), number(walls.size(), kNone);
    for (int s = 0; s < std::ssize(twin_); ++s) {
      if (!is_wall(s) || (twin_[s] != kNone && twin_[s] < s)) continue;
      ++walls[p_.side_nodes[s]];
      ++walls[p_.side_nodes[following(s)]];
    }
    for (std::size_t n = 0; n < walls.size(); ++n) {
      if (walls[n] == 0) continue;
      number[n] = static_cast<int>(cells.vertices.triangles.size());
      cells.vertices.push_back(p_.nodes.triangles[n], p_.nodes.barycentric[n]);
      cells.is_needed.push_back(walls[n] != 2);
    }
    for (std::size_t c = 0; c < cells.corner_vertices.size(); ++c) {
      int& vertex = cells.corner_vertices[c];
      vertex = number[vertex];
      const auto& [x, y] = cells.corner_points[c];
      // Corners of tiles are needed in any case.
      if (x == std::round(x) && y == std::round(y)) cells.is_needed[vertex] = 1;
    }
  }

  const Pieces& p_;
  std::vector<char> is_wall_;
  std::vector<int> piece_, twin_;  // #S; the side of the other piece on the same segment
  std::vector<int> cell_, turn_;   // #P; from the chart of the piece to that of its cell
  std::vector<char> is_broken_;    // #P: cells that are not disks with a simple outline
};

}  // namespace

Cells cells(const Pieces& pieces, Execution& execution) { return Joining(pieces).run(execution); }

}  // namespace holomorph::tiles
