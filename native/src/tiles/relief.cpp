#include "tiles/relief.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

#include "tiles/sharp_zones.h"

namespace holomorph::tiles {
namespace {

using Index = Eigen::Index;

constexpr int kFewest = 3, kMost = 12;  // parts of a triangle's side, between which heights are sampled

// The pixel of `count` in which x lies; the tile is from 0 to 1, and repeats.
Index cell(double x, Index count) {
  const double turn = x - std::floor(x);
  return std::min(static_cast<Index>(turn * static_cast<double>(count)), count - 1);
}

// The two pixels whose middles x lies between, and how near it is to the second.
struct Between {
  Index first, second;
  double part;
};

Between between(double x, Index count) {
  const double place = (x - std::floor(x)) * static_cast<double>(count) - 0.5, low = std::floor(place);
  const Index first = (static_cast<Index>(low) + count) % count;
  return {first, first + 1 == count ? 0 : first + 1, place - low};
}

// The highest of each pixel and its neighbours.
HeightImage::Pixels widened(const HeightImage::Pixels& pixels) {
  const Index rows = pixels.rows(), columns = pixels.cols();
  HeightImage::Pixels wide = pixels, result = pixels;
  for (const Index d : {Index{1}, columns - 1}) {
    for (Index j = 0; j < columns; ++j) wide.col(j) = wide.col(j).max(pixels.col((j + d) % columns));
  }
  result = wide;
  for (const Index d : {Index{1}, rows - 1}) {
    for (Index i = 0; i < rows; ++i) result.row(i) = result.row(i).max(wide.row((i + d) % rows));
  }
  return result;
}

double middle(Index i, Index count) { return (static_cast<double>(i) + 0.5) / static_cast<double>(count); }

constexpr int kReported = 4096;
constexpr double kLeastTolerance = 1e-4;

// Side i runs from corner i to corner i + 1.
struct Triangle {
  std::array<int, 3> vertices;
  std::array<int, 3> across;  // the triangle at each side, or none
  std::array<Point, 3> tiles;
  CornerNormals normals;
  std::array<bool, 3> are_reflex;
  int parent;
  int version = 0;  // how often it was split
};

struct Candidate {
  double error;
  int triangle, version;

  bool operator<(const Candidate& other) const {
    return std::tie(error, other.triangle) < std::tie(other.error, triangle);  // the lower number first
  }
};

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

class Refining {
 public:
  Refining(const mesh::Surface& surface, const TileCoordinates& coordinates, std::vector<ReliefSite> sites,
           const std::vector<SmoothCorners>& corners, const HeightImage& image, const ReliefOptions& options)
      : image_(image),
        options_(options),
        sites_(std::move(sites)),
        heights_(sites_.size(), 0.0),
        zones_(sites_, options.depth) {
    const int count = static_cast<int>(surface.triangles.size());
    triangles_.resize(count);
    std::vector<int> first(surface.edges.size(), kNone);  // 3 t + i of the first side at each edge
    for (int t = 0; t < count; ++t) {
      Triangle& own = triangles_[t];
      own = {surface.triangles[t], {kNone, kNone, kNone}, {}, corners[t].normals, corners[t].are_reflex, t};
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 2; ++k) own.tiles[i][k] = coordinates.points[t][i][k] / coordinates.unit;
        zones_.add_corner(own.vertices[i], own.normals[i]);
        // The same from every triangle at the vertex: tile coordinates differ by whole tiles, and the image has period
        // 1. Around poles, where they do not, the share is 0.
        heights_[own.vertices[i]] = height(sites_[own.vertices[i]].share, own.tiles[i]);
        int& other = first[surface.triangle_edges[t][i]];
        if (other != kNone) {
          own.across[i] = other / 3;
          triangles_[other / 3].across[other % 3] = t;
        }
        other = 3 * t + i;
      }
    }
  }

  Relief run(Execution& execution) {
    for (int t = 0; t < std::ssize(triangles_); ++t) look_at(t);
    bool is_full = false;
    for (std::size_t i = 0; !candidates_.empty() && !is_full; ++i) {
      const Candidate next = candidates_.top();
      // Candidates of triangles that were split since are out of date.
      if (triangles_[next.triangle].version == next.version) is_full = !split(next.triangle);
      if (!is_full) candidates_.pop();
      if (i % kReported == 0) execution.report(static_cast<double>(triangles_.size()) / options_.most_triangles);
    }
    return result(is_full);
  }

 private:
  double height(double share, const Point& tile) const {
    return share == 0 ? 0 : share * (image_.at(tile) - options_.level);
  }

  void look_at(int t) {
    const double error = std::max(error_of(triangles_[t]), error_of_direction(triangles_[t]));
    if (error > options_.tolerance)
      candidates_.push({error, t, triangles_[t].version});
    else
      error_ = std::max(error_, error);
  }

  double error_of(const Triangle& t) const {
    const auto of = [&t](const auto& value) {
      return std::array{value(t.vertices[0]), value(t.vertices[1]), value(t.vertices[2])};
    };
    const auto shares = of([this](int v) { return sites_[v].share; });
    const auto heights = of([this](int v) { return heights_[v]; });
    return image_.error({t.tiles, shares, heights}, options_.level, options_.finest_pixels);
  }

  // Just above the tolerance where a triangle is large for how near it is to a sharp edge, so that errors of heights
  // come first; the more, the larger it is.
  double error_of_direction(const Triangle& t) const {
    const auto is_moved = [this](int v) { return std::abs(heights_[v]) > options_.tolerance; };
    if (std::none_of(t.vertices.begin(), t.vertices.end(), is_moved)) return 0;
    double excess = 0;
    for (int i = 0; i < 3; ++i) {
      if (sites_[t.vertices[i]].share == 0) continue;
      const SharpZone zone = zones_.of(t.vertices[i], t.normals[i], t.are_reflex[i]);
      for (int k = 1; k < 3; ++k)
        excess = std::max(excess, zones_.excess(zone, t.vertices[i], t.vertices[(i + k) % 3]));
    }
    return excess == 0 ? 0 : std::max(options_.tolerance, kLeastTolerance) * (1 + excess);
  }

  double squared_length(int a, int b) const { return (sites_[a].position - sites_[b].position).squaredNorm(); }

  // An order of all sides, the same from both triangles.
  std::tuple<double, int, int> key(const Triangle& t, int i) const {
    const auto [low, high] = std::minmax(t.vertices[i], t.vertices[(i + 1) % 3]);
    return {squared_length(low, high), low, high};
  }

  int longest_side(const Triangle& t) const {
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (key(t, longest) < key(t, i)) longest = i;
    }
    return longest;
  }

  // The side of a triangle from one vertex to another.
  static int side_from(const Triangle& t, int from, int to) {
    int i = 0;
    while (t.vertices[i] != from || t.vertices[(i + 1) % 3] != to) ++i;
    return i;
  }

  // Splits t at its longest side, after the triangles across that have a longer one (Rivara 1984). Returns false where
  // there would be too many triangles. It ends, since sides get longer along the way.
  bool split(int t) {
    for (const int version = triangles_[t].version; triangles_[t].version == version;) {
      int at = t, i = longest_side(triangles_[t]);
      for (;;) {
        const int next = triangles_[at].across[i];
        if (next == kNone) break;
        const int j = longest_side(triangles_[next]);
        if (triangles_[next].across[j] == at) break;
        at = next;
        i = j;
      }
      if (std::ssize(triangles_) + 2 > options_.most_triangles) return false;
      halve_side(at, i);
    }
    return true;
  }

  // The normals of a side at its two ends and in its middle, on which both its triangles agree.
  CornerNormals side_normals(const Triangle& t, int i) const {
    const int next = (i + 1) % 3, other = t.across[i];
    CornerNormals own{t.normals[i], t.normals[next], (t.normals[i] + t.normals[next]) / 2};
    if (other == kNone) return own;
    const Triangle& beyond = triangles_[other];
    const int j = side_from(beyond, t.vertices[next], t.vertices[i]), k = (j + 1) % 3;
    return {between_faces(own[0], beyond.normals[k]), between_faces(own[1], beyond.normals[j]),
            between_faces(own[2], (beyond.normals[j] + beyond.normals[k]) / 2)};
  }

  void halve_side(int t, int i) {
    const Triangle& own = triangles_[t];
    const int a = own.vertices[i], b = own.vertices[(i + 1) % 3], other = own.across[i];
    const int middle = static_cast<int>(sites_.size());
    // Position and share stay linear along the side, and so do the normals of each triangle. The height is sampled
    // anew.
    const CornerNormals ends = side_normals(own, i);
    const SharpZone zone = zones_.between(zones_.of(a, ends[0], own.are_reflex[i]),
                                          zones_.of(b, ends[1], own.are_reflex[(i + 1) % 3]), a, b);
    const bool is_sharp = ends[2] != (own.normals[i] + own.normals[(i + 1) % 3]) / 2;
    zones_.add_middle(zone, a, b, is_sharp);
    const Eigen::Vector3d at = (sites_[a].position + sites_[b].position) / 2;
    sites_.push_back({at, ends[2] + zones_.rest(zone, at), (sites_[a].share + sites_[b].share) / 2});
    const Point &p = own.tiles[i], &q = own.tiles[(i + 1) % 3];
    heights_.push_back(height(sites_[middle].share, {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2}));
    const int second = halve(t, i, middle);
    if (other != kNone) {
      const int fourth = halve(other, side_from(triangles_[other], b, a), middle);
      join(t, fourth);
      join(second, other);
      look_at(other);
      look_at(fourth);
    }
    look_at(t);
    look_at(second);
  }

  // Makes (a, m, c) of (a, b, c), and a new triangle (m, b, c), whose number is returned. The halves of the side are
  // their sides 0.
  int halve(int t, int i, int middle) {
    const int second = static_cast<int>(triangles_.size());
    Triangle& first = triangles_[t];
    const auto turned = [i](const auto& values) {
      return std::array{values[i], values[(i + 1) % 3], values[(i + 2) % 3]};
    };
    const auto [a, b, c] = turned(first.vertices);
    const auto [p, q, r] = turned(first.tiles);
    const auto [n, o, l] = turned(first.normals);
    const Eigen::Vector3d between = (n + o) / 2;
    const auto [e, f, g] = turned(first.are_reflex);
    const int right = turned(first.across)[1], left = turned(first.across)[2], version = first.version + 1;
    const Point m{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    const int parent = first.parent;
    first = {{a, middle, c}, {kNone, second, left}, {p, m, r}, {n, between, l}, {e, false, g}, parent, version};
    triangles_.push_back({{middle, b, c}, {kNone, right, t}, {m, q, r}, {between, o, l}, {false, f, g}, parent});
    if (right != kNone) triangles_[right].across[side_from(triangles_[right], c, b)] = second;
    return second;
  }

  void join(int s, int t) {
    triangles_[s].across[0] = t;
    triangles_[t].across[0] = s;
  }

  Relief result(bool is_full) {
    Relief made;
    for (std::size_t v = 0; v < sites_.size(); ++v) {
      made.positions.push_back(array_of(sites_[v].position));
      made.offsets.push_back(array_of(heights_[v] * sites_[v].normal));
    }
    for (const Triangle& t : triangles_) {
      made.triangles.push_back(t.vertices);
      made.parents.push_back(t.parent);
      made.tiles.push_back({t.tiles[0][0], t.tiles[0][1], t.tiles[1][0], t.tiles[1][1], t.tiles[2][0], t.tiles[2][1]});
    }
    made.heights = std::move(heights_);
    // The triangle that could not be split is still in the queue, whose top has the largest error.
    made.error = is_full ? candidates_.top().error : error_;
    made.is_full = is_full;
    return made;
  }

  const HeightImage& image_;
  const ReliefOptions& options_;
  std::vector<ReliefSite> sites_;  // #V
  std::vector<double> heights_;    // #V
  SharpZones zones_;               // of the sites
  std::vector<Triangle> triangles_;
  std::priority_queue<Candidate> candidates_;  // those that are off by more than the tolerance, and earlier versions
  double error_ = 0;                           // of the others
};

}  // namespace

HeightImage::HeightImage(Pixels pixels) {
  levels_.push_back({std::move(pixels), {}, {}});
  while (levels_.back().mean.size() > 1) {
    Level coarse = halved(levels_.back());
    levels_.back().rest = {};  // of which `around` is left
    levels_.push_back(std::move(coarse));
  }
}

double HeightImage::rest(const Point& tile, int level) const {
  const Pixels& values = levels_[level].around;
  return values(cell(tile[1], values.rows()), cell(tile[0], values.cols()));
}

double HeightImage::error(const HeightTriangle& t, double level, double finest) const {
  if (t.shares == std::array{0.0, 0.0, 0.0}) return 0;
  double longest = 0;  // in pixels
  for (int i = 0; i < 3; ++i) {
    const Point &from = t.tiles[i], &to = t.tiles[(i + 1) % 3];
    longest = std::max(longest, std::hypot((to[0] - from[0]) * columns(), (to[1] - from[1]) * rows()));
  }
  if (longest < finest) return 0;
  const int parts = static_cast<int>(std::clamp(std::ceil(longest) + 1, double{kFewest}, double{kMost}));
  const double step = longest / parts;
  const int depth = step <= 1 ? 0 : std::min(std::ilogb(step) + 1, level_count() - 1);
  double error = 0;
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; i + j <= parts; ++j) {
      const double y = static_cast<double>(i) / parts, z = static_cast<double>(j) / parts, x = 1 - y - z;
      const auto linear = [=](double a, double b, double c) { return x * a + y * b + z * c; };
      const Point place{linear(t.tiles[0][0], t.tiles[1][0], t.tiles[2][0]),
                        linear(t.tiles[0][1], t.tiles[1][1], t.tiles[2][1])};
      const double share = linear(t.shares[0], t.shares[1], t.shares[2]);
      const double flat = linear(t.heights[0], t.heights[1], t.heights[2]);
      const double off = std::abs(share * (at(place, depth) - level) - flat);
      error = std::max(error, off + (depth > 0 ? share * rest(place, depth) : 0));
    }
  }
  return error;
}

double HeightImage::bilinear(const Pixels& pixels, double u, double v) {
  const Between x = between(u, pixels.cols()), y = between(v, pixels.rows());
  const double low = std::lerp(pixels(y.first, x.first), pixels(y.first, x.second), x.part);
  const double high = std::lerp(pixels(y.second, x.first), pixels(y.second, x.second), x.part);
  return std::lerp(low, high, y.part);
}

HeightImage::Level HeightImage::halved(const Level& fine) {
  const Index rows = (fine.mean.rows() + 1) / 2, columns = (fine.mean.cols() + 1) / 2;
  Level coarse{Pixels(rows, columns), Pixels::Zero(rows, columns), {}};
  const double x = 0.25 / static_cast<double>(columns), y = 0.25 / static_cast<double>(rows);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      const double u = middle(j, columns), v = middle(i, rows);
      // The mean of the fine image at four points of the pixel. An odd number of pixels is no obstacle.
      coarse.mean(i, j) = (bilinear(fine.mean, u - x, v - y) + bilinear(fine.mean, u + x, v - y) +
                           bilinear(fine.mean, u - x, v + y) + bilinear(fine.mean, u + x, v + y)) /
                          4;
    }
  }
  for (Index i = 0; i < fine.mean.rows(); ++i) {
    for (Index j = 0; j < fine.mean.cols(); ++j) {
      const double u = middle(j, fine.mean.cols()), v = middle(i, fine.mean.rows());
      // The error of the fine level, plus that of the coarse level against the fine one, at the middle of each fine
      // pixel.
      double& rest = coarse.rest(cell(v, rows), cell(u, columns));
      const double lost = fine.rest.size() == 0 ? 0 : fine.rest(i, j);
      rest = std::max(rest, lost + std::abs(fine.mean(i, j) - bilinear(coarse.mean, u, v)));
    }
  }
  coarse.around = widened(coarse.rest);
  return coarse;
}

Relief relief(const mesh::Surface& surface, const TileCoordinates& coordinates, const std::vector<ReliefSite>& sites,
              const std::vector<SmoothCorners>& corners, const HeightImage& image, const ReliefOptions& options,
              Execution& execution) {
  return Refining(surface, coordinates, sites, corners, image, options).run(execution);
}

}  // namespace holomorph::tiles
