// Maps in islands: cut along hard edges, each piece flattened, pieces laid edge to edge as a paper net.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "base/constants.h"
#include "base/execution.h"
#include "flat/island_layout.h"
#include "mesh/surface.h"

namespace holomorph::flat {

/// Degrees between two faces, from which on a seam is expected, if need be.
inline constexpr std::array<double, 3> kHardAngles{60, 40, 30};
/// Degrees: a part without sharper edges is a coarse mesh of something smooth.
inline constexpr double kSmoothAngle = 35;
/// What remains of what is minded of the squares when they are evened, about, as it was seen on a dozen meshes.
inline constexpr double kEvenedCost = 0.45;

struct IslandOptions {
  double evenness = 0;     ///< from 0, conformal, to 1 (uv/evening.h)
  uv::Up up = uv::Up::kZ;  ///< the axis of the positions that points up
  bool is_upright = true;  ///< whether pieces are to stay so
};

/// Where islands are cut if that is chosen.
struct ChosenCuts {
  std::vector<mesh::Pair> seams;  ///< vertices of edges; other pairs do not count
  double hard_degrees = 0;        ///< edges that break off by more are cut, too; 0: none
  double most_stretch = 0;        ///< factor of lengths, beyond which an island is cut open to cone points; 0: nowhere

  bool operator==(const ChosenCuts&) const = default;
};

/// The islands of a surface, looked for as far as they are worth it: along hard edges, then also to cone points and
/// between what overlaps, for one angle of hard edges after the other. All is first laid out conformal, which is quick.
/// Only what may be the best is evened.
class IslandSearch {
 public:
  /// @pre the surface is connected and has positions
  IslandSearch(const mesh::Surface& surface, const IslandOptions& options, Execution& execution);

  /// The best that was found.
  const std::shared_ptr<const Layout>& known() const { return known_; }

  /// The islands of least cost, if it is below `most`, and they are found by so much work. What was found for other
  /// bounds is taken where it does. @param work in millionths of about a second of one processor. @throws Cancelled
  std::shared_ptr<const Layout> best(double most, double work, Execution& execution);

  /// Those of least cost but for hard seams and direction, if it is below `most`. Quick: what is hopeless is not cut to
  /// cone points. @throws Cancelled
  std::shared_ptr<const Layout> at_once(double most, Execution& execution);

  /// Those between chosen cuts, however they look: each lies for itself, none over itself. @throws TopologyError where
  /// a piece has no flat map; Cancelled
  std::shared_ptr<const Layout> along(const ChosenCuts& chosen, Execution& execution) const;

 private:
  struct Bounds {
    double most = -kInfinity, work = -kInfinity;
  };
  // How a search goes on.
  struct Run {
    double left = kInfinity;      // work
    double hopeless = kInfinity;  // cost from which on no cuts to cone points follow
    bool is_quick = false;        // hard seams and direction do not count
  };
  struct Candidate;

  std::shared_ptr<const Layout> search(double most, Run run, Execution& execution) const;
  bool is_tried(double degrees, bool is_wanted) const;
  std::vector<char> hard(double degrees) const;
  std::optional<Layout> along(const Cuts& cuts, double most, Run& run, Execution& execution) const;
  std::vector<Candidate> candidates(Cuts cuts, double most, int rounds, Run& run, Execution& execution) const;
  std::optional<Flattened> flattened(const Cuts& cuts, double most, Run& run, Execution& execution) const;
  bool cut_to_cones(Cuts& cuts, const Flattened& flattened, double most, Run& run, Execution& execution) const;
  double cost(const Layout& islands, const Run& run) const;
  double guess(const Layout& islands, const Run& run) const;
  Layout as_given(Layout found, Execution& execution) const;

  const mesh::Surface& given_;
  IslandOptions options_;
  std::vector<int> order_;  // #C of the sheet: the corner of the surface as given; empty where that is its own
  Sheet sheet_;
  std::shared_ptr<const Layout> known_;
  Bounds asked_;  // for which they were looked for
};

/// The islands of a connected surface; nothing where a piece cannot be flattened, as where it is closed.
///
/// The surface is cut along edges where it breaks off by more than 60 degrees, a bevel once, and by more than 40 and 30
/// where pieces stretch or lie over themselves, whichever looks best; from tips to these edges, and until all pieces
/// are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more than a
/// factor of 2.5, it is cut open to its cone points too if that looks better, and parted where it lies over itself.
/// Pieces are turned upright, and those that fit edge to edge are joined: first those that stay upright, longer edges
/// first. Source: Sawhney and Crane 2017, section 4, for each piece; cuts and joints are ours, docs/choice.md.
/// @throws Cancelled
std::shared_ptr<const Layout> island_map(const mesh::Surface& surface, const IslandOptions& options,
                                         Execution& execution);

}  // namespace holomorph::flat
