#include "choice/automatic_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <unordered_map>
#include <utility>

#include "choice/map_search.h"
#include "choice/side_by_side.h"

namespace holomorph::choice {
namespace {

constexpr double kLeading = 0.25;  // part of the area of the largest part, from which on a part may say the density
constexpr double kSolving = 0.5;   // part of the work, for what needs no size
constexpr double kTrying = 0.9;    // part of the work on tilings, for numbers of tiles
constexpr double kScales = 1e3;    // of the logarithm of a copy's scale: parts that differ by less have the same tiles
constexpr double kTolerance = 0.2;
constexpr double kLeastTiles = 100, kTilesPerHandle = 64;  // over the largest part, by default

// A part, and the scale of the copies of it that share a map.
using Name = std::pair<int, long>;

// What refuses one part is its result: others go on.
template <class Value>
struct OrRefused {
  Value value{};
  std::exception_ptr refused;
};

template <class Make>
auto or_refused(const Make& make) -> OrRefused<decltype(make())> {
  const auto refused = [](const Error&) { return OrRefused<decltype(make())>{{}, std::current_exception()}; };
  try {
    return unless_refused([&] { return OrRefused<decltype(make())>{make(), {}}; }, refused);
  } catch (const std::bad_alloc&) {
    return {{}, std::current_exception()};
  }
}

std::string message(const std::exception_ptr& refused) {
  try {
    std::rethrow_exception(refused);
  } catch (const std::exception& error) {
    return error.what();
  }
}

bool is_memory(const std::exception_ptr& refused) {
  try {
    std::rethrow_exception(refused);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

// The density of a copy's map on the first part.
double on_first(double density, const Copy& copy) { return density * copy.scale * copy.scale; }

// Whether the same is asked of two parts. A structure that is given may be of choices on that part.
bool are_alike(const Request& a, const Request& b) {
  const bool may_be_chosen = a.main == Main::kBalanced || b.main == Main::kBalanced;
  if (may_be_chosen && a.structure != b.structure) return false;
  return a.main == b.main && a.evenness == b.evenness && a.tiling == b.tiling && a.rows == b.rows && a.cuts == b.cuts &&
         a.effort == b.effort;
}

bool are_same(const mesh::Surface& a, const mesh::Surface& b) {
  return !a.intrinsic() && a.polygons.vertices == b.polygons.vertices &&
         a.polygons.corner_vertices == b.polygons.corner_vertices && a.polygons.face_offsets == b.polygons.face_offsets;
}

// The copy that each part is, of one of its own object, or of exactly the same in another: so an object alone has the
// maps that it has beside others. Parts of which something else is asked are no copies. Nor are those that are turned
// about the vertical if u is to run along a vector.
std::vector<Copy> alike_parts(const std::vector<std::vector<Request>>& objects,
                              const std::vector<const Request*>& requests, Execution& execution) {
  std::vector<Copy> result;
  std::unordered_multimap<std::size_t, int> same;  // by a hash of their positions
  for (const std::vector<Request>& object : objects) {
    const int first = static_cast<int>(result.size());
    std::vector<PartPointer> parts;
    bool are_level = true;
    for (const Request& request : object) {
      parts.push_back(request.part);
      are_level &= request.tiling.heading.kind != Heading::Kind::kVector;
    }
    const std::vector<Copy> own = are_level ? copies(parts, execution) : std::vector<Copy>();
    for (int k = 0; k < std::ssize(object); ++k) {
      const Copy copy = are_level ? own[k] : Copy{k};
      if (copy.first != k && are_alike(object[copy.first], object[k])) {
        const Copy& known = result[first + copy.first];
        result.push_back({known.first, copy.scale * known.scale});
        continue;
      }
      const mesh::Surface& surface = *object[k].part->surface;
      const std::size_t hash = hash_of(surface.polygons.vertices);
      const auto [begin, end] = same.equal_range(hash);
      const auto known = std::find_if(begin, end, [&](const auto& entry) {
        const Request& other = *requests[entry.second];
        return are_same(*other.part->surface, surface) && are_alike(other, object[k]);
      });
      const int index = known == end ? first + k : known->second;
      if (known == end && !surface.intrinsic()) same.emplace(hash, index);
      result.push_back({index});
    }
  }
  return result;
}

using Search = OrRefused<std::unique_ptr<MapSearch>>;
using Found = OrRefused<MapPointer>;
using Tried = OrRefused<std::vector<MapPointer>>;

// The maps of parts whose map depends on the size of squares.
class Sizing {
 public:
  Sizing(const std::vector<const Request*>& requests, const std::vector<Copy>& alike, std::map<int, Search>& searches,
         const SizePolicy& size)
      : requests_(requests), alike_(alike), searches_(searches), size_(size) {}

  /// @param members parts in ascending order. @return whether there is a part that leads, and which; others' size
  std::pair<std::optional<int>, SizePolicy> map(const std::vector<int>& members, Execution& execution);

  const Found& of(int part) const { return made_.at(name(part)); }

 private:
  Name name(int part) const { return {alike_[part].first, std::lround(std::log(alike_[part].scale) * kScales)}; }
  const Part& part(int k) const { return *requests_[k]->part; }
  std::vector<int> leaders(const std::vector<int>& members) const;
  std::optional<int> lead(const std::vector<int>& members, double& share, Execution& execution);
  Window fit(const std::vector<std::pair<Name, double>>& wanted, std::optional<Window> window, Execution& execution);

  const std::vector<const Request*>& requests_;
  const std::vector<Copy>& alike_;
  std::map<int, Search>& searches_;
  const SizePolicy& size_;
  std::map<Name, double> areas_;
  std::map<Name, Found> made_;
};

// The parts that may say the density of all, the largest first.
std::vector<int> Sizing::leaders(const std::vector<int>& members) const {
  std::map<Name, int> firsts;
  for (const int k : members) firsts.try_emplace(name(k), k);
  double largest = 0;
  for (const auto& [name, k] : firsts) largest = std::max(largest, part(k).area);
  std::vector<int> result;
  for (const auto& [name, k] : firsts) {
    if (part(k).area >= kLeading * largest) result.push_back(k);
  }
  std::ranges::sort(result, {}, [&](int k) { return std::pair(-part(k).area, k); });
  return result;
}

// The first one with a tiling leads, or with pieces that are tilings: these may have any density, a tiling of the whole
// part may not.
std::optional<int> Sizing::lead(const std::vector<int>& members, double& share, Execution& execution) {
  std::optional<int> leader;
  double all = 0;
  for (const auto& [name, area] : areas_) all += area;
  for (const int k : leaders(members)) {
    const double wanted = on_first(size_.density, alike_[k]);
    const double end = share + 0.5 * part(k).area / (all > 0 ? all : 1);  // the rest is for other maps of the part
    Found found = nested(execution, share, end, [&] {
      execution.stage("map", 0.0, 1.0);
      return or_refused([&] { return searches_[alike_[k].first].value->about(wanted, size_.tries, execution); });
    });
    share = end;
    const MapPointer map = found.value;
    const bool takes =
        map && map->is_tiled() && (!size_.tolerance || std::abs(relative_size(*map, wanted) - 1) <= *size_.tolerance);
    if (takes && (!leader || map->tiling())) {
      leader = k;
      made_.clear();
      made_[name(k)] = std::move(found);
    } else if (!size_.tolerance && !leader) {
      made_[name(k)] = std::move(found);
    }
    if (takes && map->tiling()) break;
  }
  return leader;
}

std::pair<std::optional<int>, SizePolicy> Sizing::map(const std::vector<int>& members, Execution& execution) {
  for (const int k : members) areas_[name(k)] += part(k).area;
  double share = 0;
  const std::optional<int> leader = size_.tolerance == 0 ? std::nullopt : lead(members, share, execution);
  SizePolicy others = size_;
  others.tolerance = 0;
  others.tries = kTries;
  if (leader) others.density = made_[name(*leader)].value->density() / (alike_[*leader].scale * alike_[*leader].scale);
  std::vector<std::pair<Name, double>> wanted;
  std::map<Name, std::size_t> places;  // in `wanted`
  for (auto k = members.rbegin(); k != members.rend(); ++k) {
    if (made_.contains(name(*k))) continue;
    const double density = on_first(others.density, alike_[*k]);
    const auto [known, is_new] = places.try_emplace(name(*k), wanted.size());
    if (is_new) wanted.emplace_back(name(*k), density);
    wanted[known->second].second = density;
  }
  const std::optional<Window> window = size_.window ? size_.window
                                       : leader     ? std::nullopt
                                                    : std::optional(window_around());
  others.window = nested(execution, std::min(share, 1.0), 1.0, [&] {
    execution.stage("map", 0.0, 1.0);
    return fit(wanted, window, execution);
  });
  return {leader, others};
}

// Makes the maps of densities by names. One of each part is tried before the others: it places the poles for all.
Window Sizing::fit(const std::vector<std::pair<Name, double>>& wanted, std::optional<Window> window,
                   Execution& execution) {
  std::map<int, Name> last;
  for (const auto& [name, density] : wanted) last[name.first] = name;
  std::vector<std::pair<Name, double>> order;
  for (const bool leads : {true, false}) {
    for (const auto& each : wanted) {
      if ((last[each.first.first] == each.first) == leads) order.push_back(each);
    }
  }
  std::vector<Tried> tried(order.size());
  std::vector<Found> made(order.size());
  const auto together = [&](std::size_t begin, std::size_t end, double from, double to, const auto& work) {
    std::vector<int> sizes;
    for (std::size_t i = begin; i < end; ++i) sizes.push_back(part(order[i].first.first).triangle_count());
    nested(execution, from, to, [&] {
      execution.stage("map", 0.0, 1.0);
      side_by_side(sizes, execution, [&](int i, Execution& own) {
        const std::size_t at = begin + static_cast<std::size_t>(i);
        work(at, *searches_[order[at].first.first].value, own);
      });
    });
  };
  const auto find = [&](std::size_t at, MapSearch& search, Execution& own) {
    tried[at] = or_refused([&] { return search.maps(order[at].second, kTries, false, own); });
  };
  together(0, last.size(), 0.0, kTrying / 2, find);
  together(last.size(), order.size(), kTrying / 2, kTrying, find);
  if (!window) {
    std::vector<Sizes> sizes;
    for (std::size_t at = 0; at < order.size(); ++at) {
      if (tried[at].refused) continue;
      Sizes& own = sizes.emplace_back(std::vector<double>(), areas_[order[at].first]);
      for (const MapPointer& map : tried[at].value) own.densities.push_back(relative_size(*map, order[at].second));
    }
    window = best_window(sizes);
  }
  together(0, order.size(), kTrying, 1.0, [&](std::size_t at, MapSearch& search, Execution& own) {
    const std::exception_ptr& refused = tried[at].refused;
    if (refused && (search.is_strict() || is_memory(refused))) {
      made[at].refused = refused;
      return;
    }
    made[at] = or_refused([&] {
      return refused ? search.instead_of_refused(message(refused), own)
                     : search.fitted(tried[at].value, order[at].second, *window, size_.near, own);
    });
  });
  for (std::size_t at = 0; at < order.size(); ++at) made_[order[at].first] = std::move(made[at]);
  return *window;
}

}  // namespace

SizePolicy SizePolicy::of_tiles(const std::vector<PartPointer>& parts, double tiles) {
  SizePolicy result;
  double area = 0;
  PartPointer largest;
  for (const PartPointer& part : parts) {
    area += part->area;
    if (!largest || part->area > largest->area) largest = part;
  }
  if (tiles > 0 && area > 0) {
    result.density = tiles / area;
  } else if (largest && largest->area > 0) {
    result.density = std::max(kLeastTiles, kTilesPerHandle * largest->type.genus) / largest->area;
  }
  result.tries = tiles > 0 ? kTries : 1;
  return result;
}

SizePolicy SizePolicy::of_density(double density, double tolerance) {
  SizePolicy result;
  result.density = density;
  result.tolerance = tolerance;
  result.near = std::min(tolerance, kTolerance);
  return result;
}

std::vector<MappedParts> map_objects(const std::vector<std::vector<Request>>& objects, const SizePolicy& size,
                                     Execution& execution) {
  std::vector<const Request*> requests;
  for (const std::vector<Request>& object : objects) {
    for (const Request& request : object) requests.push_back(&request);
  }
  execution.stage("copies", 0.0, 0.0);
  const std::vector<Copy> alike = alike_parts(objects, requests, execution);
  std::vector<int> firsts, triangles;
  for (int k = 0; k < std::ssize(alike); ++k) {
    if (alike[k].first != k) continue;
    firsts.push_back(k);
    triangles.push_back(requests[k]->part->triangle_count());
  }
  const bool is_solved = std::ranges::all_of(requests, [](const Request* one) { return one->structure != nullptr; });
  std::map<int, Search> searches;
  for (const int k : firsts) searches[k];
  execution.stage("map", 0.0, is_solved ? 0.0 : kSolving);
  side_by_side(triangles, execution, [&](int i, Execution& own) {
    searches.at(firsts[i]) =
        or_refused([&] { return std::make_unique<MapSearch>(*requests[firsts[i]], nullptr, own); });
  });
  execution.stage("map", is_solved ? 0.0 : kSolving, 1.0);
  const auto is_final = [&](int k) {
    const Search& search = searches[alike[k].first];
    return search.refused || search.value->final();
  };
  std::vector<int> members;
  for (int k = 0; k < std::ssize(alike); ++k) {
    if (!is_final(k)) members.push_back(k);
  }
  Sizing sizing(requests, alike, searches, size);
  std::optional<int> leader;
  SizePolicy others = size;
  if (!members.empty()) std::tie(leader, others) = sizing.map(members, execution);
  std::vector<MappedParts> result;
  int at = 0;
  for (const std::vector<Request>& object : objects) {
    MappedParts& mapped = result.emplace_back();
    const int end = at + static_cast<int>(object.size());
    mapped.size = others;
    if (leader && at <= *leader && *leader < end) {
      mapped.size = size;
      mapped.size.window = others.window;
    }
    for (; at < end; ++at) {
      const Search& search = searches[alike[at].first];
      Made& made = mapped.parts.emplace_back();
      made.copy = alike[at];
      if (!is_final(at)) {
        made.map = sizing.of(at).value;
        made.refused = sizing.of(at).refused;
      } else {
        made.refused = search.refused;
        if (search.value) made.map = search.value->final();
      }
    }
  }
  execution.finish();
  return result;
}

MapPointer automatic_map(const Request& request, const SizePolicy& size, Execution& execution) {
  const Made made = map_objects({{request}}, size, execution)[0].parts[0];
  if (made.refused) std::rethrow_exception(made.refused);
  return made.map;
}

}  // namespace holomorph::choice
