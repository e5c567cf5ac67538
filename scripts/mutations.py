"""The faults of scripts/mutate: each changes one text of one file, and the tests nearest to it must fail."""

from typing import NamedTuple

ROOM = "native/src/"
PACKAGE = "native/holomorph/"
CORE = "tests/core/"
LENGTHS = CORE + "mesh/test_metric_errors.py"
WEIGHTS = "native:MetricErrors*"
DELAUNAY = CORE + "mesh/test_delaunay.py"
SUMS = CORE + "forms/test_gram_errors.py"
BOUNDS = CORE + "forms/test_certified_bounds.py"
FORMS = CORE + "forms/test_conformal.py"
LOOKS = CORE + "automatic_map/test_looks.py"
EYE = CORE + "uv/test_appearance.py"
AUTOMATIC = CORE + "automatic_map/test_automatic_map.py"
PARTS = CORE + "automatic_map/test_parts.py"
SIZING = CORE + "automatic_map/test_sizing.py"
EVENED = CORE + "uv/test_evened_forms.py"
THIN = CORE + "uv/test_evened_maps.py"
VERDICT = CORE + "uv/test_verdict.py"
PAPER = CORE + "structure/test_paper_solver.py"
MEMORY = CORE + "structure/test_memory_limit.py::test_the_estimate_and_the_peak"
EQUIVALENCE = CORE + "moduli/test_equivalence_rounding.py"
SURFACES = CORE + "moduli/test_conformal_equivalence.py"
KNOWN = CORE + "moduli/test_known_periods.py"
THETA = CORE + "moduli/test_theta_constants.py"
SIMILAR = CORE + "moduli/test_similarities.py"
REFINED = CORE + "forms/test_refined_triangles.py"
NARROW = CORE + "forms/test_narrow_bounds.py"
ELEMENTS = CORE + "forms/test_element_energies.py"
REFERENCE = CORE + "forms/test_reference_elements.py"
DENSE = "native:*CertainBounds*"
DIGITS = "native:DoubleDouble*"
SLIVERS = CORE + "mesh/test_slivers.py"
WILD = CORE + "mesh/test_wild_vertices.py"
TURNED = CORE + "tiling/test_turned_tilings.py"
CARRIED = CORE + "tiling/test_carried_maps.py"
LINES = CORE + "tiling/test_turned_lines.py"
MIRRORED = CORE + "tiling/test_mirrored.py"
ASKED = CORE + "tiling/test_asked_turns.py"
OVERLAP = CORE + "flat/test_overlap.py"
MIXED = CORE + "flat/test_mixed_map.py"
CHOSEN = CORE + "tiling/test_chosen_cones.py"
DIRECTION = CORE + "uv/test_direction.py"
GLB = CORE + "files/test_gltf.py"


class Mutation(NamedTuple):
    file: str
    old: str  # which the file has once
    new: str
    tests: tuple[str, ...]


def of(file, *rows):
    """Mutations of one file by their names: (name, old, new, tests ...)."""
    return {name: Mutation(file, old, new, tuple(tests)) for name, old, new, *tests in rows}


MUTATIONS = (
    # What rounding makes of lengths, weights, sums and dense algebra: each bound, a tenth of it.
    of(
        ROOM + "mesh/metric_errors.cpp",
        ("lengths-of-positions", "kOfDistance = 3.5 * kUnit", "kOfDistance = 0.35 * kUnit", LENGTHS),
        ("lengths-given", "kOfGivenLength = 2.5 * kUnit", "kOfGivenLength = 0.25 * kUnit", LENGTHS),
        ("weights", "kOfLargest = 3 * kUnit", "kOfLargest = 0.3 * kUnit", LENGTHS),
        ("weights-of-needles", "kOfSharpSquares = 3 *", "kOfSharpSquares = 0.3 *", WEIGHTS),
        ("weights-cancelling", "kOfSharpCotangent = 39 *", "kOfSharpCotangent = 0 *", WEIGHTS),
        ("weights-grown", "kOfErrors = 3 *", "kOfErrors = 0.3 *", WEIGHTS),
        ("growth-tenth", "return is_open ? 1 : eta", "return is_open ? 1 : 0.1 * eta", LENGTHS),
        ("weights-left-blunt", "return {sharp,", "return {{given},", WEIGHTS),
    )
    | of(ROOM + "base/constants.h", ("unit", "epsilon() / 2", "epsilon() / 20", WEIGHTS, DENSE, LENGTHS, SUMS))
    | of(
        ROOM + "mesh/delaunay.cpp",
        ("flipped-length", "return {length, rounding}", "return {length, 0.1 * rounding}", LENGTHS),
        ("delaunay-tolerance", "kDelaunayTolerance = 1e-9", "kDelaunayTolerance = 1e-3", DELAUNAY),
    )
    | of(ROOM + "mesh/triangle_geometry.h", ("flatness", "kFlatMargin = 1e-15", "kFlatMargin = 1e-13", DELAUNAY))
    | of(
        ROOM + "forms/gram_matrices.cpp",
        ("gram-sums", "kUnit * (gram.summands + 6)", "kUnit * 0.1 * (gram.summands + 6)", SUMS),
        ("gram-values", "3 * of_values", "0.3 * of_values", SUMS),
        ("gram-zero-weights", "k == 0 && (w.errors.empty() || w.errors[e] == 0)", "k == 0", "native:*GramMatrices*"),
        ("gram-errors-halved", "errors = gram.uncertain", "errors = 0.5 * gram.uncertain", SUMS),
        ("gram-excess", "(1 + 16 * kUnit) * (u - rho * k)", "0.5 * (u - rho * k)", "native:*ManyForms*"),
        ("gram-usual", "rho * (1 + 8 * kUnit)", "0.1 * rho", "native:*ManyForms*"),
    )
    | of(
        ROOM + "forms/certificates.cpp",
        ("harmonicity", "0.5, faces),\n          relative", "0.5, faces),\n          0.1 * relative", FORMS),
    )
    | of(
        ROOM + "forms/certain_bounds.cpp",
        ("dense-products", "2 * G.rows() + 2", "0.2 * G.rows() + 0.2", DENSE),
        ("dense-inverse", "2 * X - above_congruent(X, A)", "X", DENSE),
        ("dense-real-parts", "MatrixXd R = (G - below) / 2", "MatrixXd R = (G - below) / 20", DENSE),
        (
            "dense-upper",
            "bounds.upper = above_congruent(T, G)",
            "bounds.upper = linear::congruent(T, G)",
            DENSE,
        ),
    )
    | of(
        ROOM + "base/double_double.h",
        ("products-cut", "p * v + q * u) + q * v", "p * v + q * u)", DIGITS),
        ("sums-cut", "(a - (sum - taken)) + (b - taken)", "b - taken", DIGITS),
    )
    | of(
        ROOM + "forms/reference_element.cpp",
        ("elements-double", "DoubleDouble{G(n, s)} * row[s]", "DoubleDouble{G(n, s) * row[s].high}", REFERENCE),
        ("elements-jacobi", "jacobi(b - 1, 2 * a - 2)", "jacobi(b - 1, 2 * a - 1)", REFERENCE),
    )
    | of(
        ROOM + "forms/element_forms.cpp",
        ("elements-metric", "sums[i].uncertain += own", "sums[i].uncertain += 0.9 * own", ELEMENTS),
        ("elements-signs", "if (k % 2 == 1) signs", "if (k % 2 == 0) signs", ELEMENTS),
    )
    | of(
        ROOM + "mesh/metric_errors.cpp",
        ("elements-faces", "error * cotangent + (1 + error) * rounding", "rounding", ELEMENTS),
    )
    | of(
        PACKAGE + "forms/refined_triangles.py",
        ("distances", "OF_DISTANCE = 3 *", "OF_DISTANCE = 0.3 *", REFINED),
        ("lengths-growth", "change * (1 + change), 1)", "0.1 * change, 1)", REFINED),
        ("lengths-after-others", "errors + growth + errors * growth", "errors + growth", REFINED),
        ("areas-of-needles", "(c - (a - b)) * (c + (a - b))", "(c - a + b) * (c + a - b)", REFINED),
        ("points-of-classes", "at_end == self.along[t, side]", "at_end", REFINED),
    )
    | of(
        PACKAGE + "forms/certificate.py",
        ("slack-none", "SLACK = 2.0**-50", "SLACK = 0.0", BOUNDS),
        ("slack-tenth", "SLACK = 2.0**-50", "SLACK = 0.1 * 2.0**-50", BOUNDS),
    )
    # Solvers, memory, invariants.
    | of(
        ROOM + "structure/paper_forms.cpp",
        ("paper-strict", "report.converged || report.is_rounding", "report.converged", PAPER),
        ("paper-levels", "row = std::move(system.row);", "row = system.row; X.setZero();", PAPER),
    )
    | of(
        ROOM + "solver/conjugate_gradients.cpp",
        ("gradients-rounding", "norm <= kRoundingOfTerms * terms(b)", "norm <= 1e10 * terms(b)", "native:*Gradients*"),
    )
    | of(
        ROOM + "structure/harmonic_solver.cpp",
        ("memory-edges", "kPerEdge = 150", "kPerEdge = 37", MEMORY),
        ("memory-multigrid", "kMultigrid = 350", "kMultigrid = 87", MEMORY),
        ("memory-columns", "kPerColumn = 24", "kPerColumn = 6", MEMORY),
        ("memory-dense", "kDenseMatrices = 40", "kDenseMatrices = 10", MEMORY),
        ("memory-direct", "kDirectCopies = 6 * 8", "kDirectCopies = 0", MEMORY),
    )
    | of(
        ROOM + "moduli/equivalence.cpp",
        ("equivalence-rounding", "kLeastTolerance = 1e-9", "kLeastTolerance = 1e-7", EQUIVALENCE),
        (
            "equivalence-margin",
            "least = std::min(least, isometry.excess)",
            "least = std::max(least, isometry.excess)",
            EQUIVALENCE,
        ),
    )
    | of(
        PACKAGE + "moduli/equivalence.py",
        ("near", "NEAR = 0.01", "NEAR = 0.1", SURFACES),
        ("agreement-loose", "AGREEMENT = 0.25", "AGREEMENT = 0.5", SURFACES),
        ("agreement-strict", "AGREEMENT = 0.25", "AGREEMENT = 0.1", SURFACES),
        ("agreement-of-different", "found.residual <= first.rounding + second.rounding", "True", SURFACES),
    )
    | of(
        ROOM + "moduli/similarities.cpp",
        ("similar-loose", "least_ <= most_}", "least_ <= 1.0000001 * most_}", SIMILAR),
        ("similar-strict", "(size(a) + size(b))", "0", SIMILAR),
    )
    | of(
        PACKAGE + "moduli/symplectic.py",
        ("theta-terms", "SMALLEST_TERM = 40.0", "SMALLEST_TERM = 10.0", THETA),
    )
    # Period matrices that are given.
    | of(
        PACKAGE + "forms/certificate.py",
        ("periods-distance", "-np.log1p(-norm)", "norm", KNOWN),
        ("periods-error-lost", "result.error = float(error)", "result.error = 0.0", KNOWN),
    )
    | of(
        PACKAGE + "moduli/equivalence.py",
        ("periods-asymmetry", "change = np.abs(np.asarray(period_matrix) - omega) + ", "change = ", KNOWN),
        ("periods-error-ignored", 'getattr(period_matrix, "error", 0.0) + ', "", SURFACES),
    )
    # What maps look like.
    | of(
        ROOM + "tiling/rounding/rounding.cpp",
        ("rounding-weights", "kConformal = 5, kEvenness = 0.15", "kConformal = 50, kEvenness = 1.5", LOOKS),
        ("rounding-conformal", "kConformal = 5", "kConformal = 50", LOOKS),
        ("rounding-evenness", "kEvenness = 0.15", "kEvenness = 1.5", LOOKS),
    )
    | of(
        ROOM + "tiling/poles/pole_placement.cpp",
        ("poles-without", "kEvenedWithout = 2.85", "kEvenedWithout = 5.7", LOOKS),
        ("poles-enough", "kEvened = 2.75", "kEvened = 5.5", LOOKS),
        ("poles-too-many", "kEvened = 2.75", "kEvened = 1.4", LOOKS),
    )
    | of(
        ROOM + "uv/evening.h",
        ("evening-power", "kUsualPower = 0.6", "kUsualPower = 0.9", LOOKS),
    )
    | of(
        PACKAGE + "quality/verdicts.py",
        ("unseen", "UNSEEN = 0.3", "UNSEEN = 0.6", EVENED),
        ("by-area", "weights @ lists[name]", "np.mean(lists[name])", VERDICT),
        ("told-overlaps", "cost(quality, seen) - of_overlaps(quality)", "cost(quality, seen)", VERDICT),
        ("little-tiled", "TILED = 0.1 ", "TILED = 0.05 ", VERDICT),
        ("whole-cost", "cost(quality) + seen.cost", "cost(quality)", VERDICT),
        ("folded", "if seen.folded > FOLDED", "if seen.folded > 9", VERDICT),
    )
    | of(
        ROOM + "mesh/hard_edges.cpp",
        ("strips", "kNarrow = 2.5", "kNarrow = 0.25", "tests/core/mesh/test_facets.py"),
        ("curved-facets", "kLevel = 0.97", "kLevel = 0.0", LOOKS),
    )
    | of(
        PACKAGE + "mesh/hard_edges.py",
        ("blades", "np.isin(sharp, ", "~np.isin(sharp, ", VERDICT),
    )
    | of(
        ROOM + "choice/size.h",
        ("like-size", "kLikeSize = 1.095", "kLikeSize = 1.19", SIZING),
    )
    | of(
        ROOM + "choice/candidate.h",
        ("good-islands", "kGood = 0.8,", "kGood = 8.0,", LOOKS),
    )
    | of(
        ROOM + "choice/candidate.cpp",
        ("bound-unread", "if (!(bound <", "if (false && !(bound <", "native:Least*"),
        ("judge-unheard", "each.judges && made", "false && made", "native:Least*"),
        ("budget-unread", "if (best && !budget", "if (false && !budget", "native:Least*"),
    )
    | of(
        ROOM + "choice/untiled.h",
        ("most-curved", "kMostCurved = 8 *", "kMostCurved = 0.8 *", LOOKS),
    )
    | of(
        ROOM + "uv/appearance.h",
        ("seams-free", "kSeam = 0.5;", "kSeam = 0.05;", EYE),
        ("shear-free", "kShear = 2;", "kShear = 0.2;", EYE),
    )
    | of(
        ROOM + "choice/part.cpp",
        ("copies", "kSingle = 0x1p-22", "kSingle = 0x1p-18", PARTS),
        ("copies-tenth", "kSingle = 0x1p-22", "kSingle = 0x1p-25", PARTS),
    )
    | of(ROOM + "mesh/input_filter.h", ("wild", "kWild = 1e9", "kWild = 1e13", WILD))
    | of(
        ROOM + "mesh/cut_open.cpp",
        ("slivers-shortest-sides", "surface.edge_lengths[a] > surface", "surface.edge_lengths[a] < surface", SLIVERS),
        ("slivers-rounding", "kCoordinateRounding = 0x1p-20", "kCoordinateRounding = 0x1p-40", SLIVERS),
    )
    | of(ROOM + "mesh/stitching.cpp", ("slivers-as-others", "? 2 : 0;  // what", "? 0 : 0;  // what", SLIVERS))
    | of(ROOM + "mesh/cut_open.cpp", ("paths-stop", "kShortest = 1e-12", "kShortest = 0", SLIVERS))
    | of(ROOM + "mesh/hard_edges.cpp", ("slivers-own-normals", "sums[owners[f]]", "sums[f]", SLIVERS))
    | of(ROOM + "uv/quality.cpp", ("overlap-twice", "std::abs(winding) > 1", "std::abs(winding) > 2", OVERLAP))
    | of(ROOM + "flat/pieces.cpp", ("windows-shortest", "std::pair(-a.length", "std::pair(a.length", MIXED))
    | of(ROOM + "flat/island_layout.cpp", ("same-place", "kSame = 1e-5", "kSame = 1e-6", SLIVERS))
    | of(
        ROOM + "tiling/cones/transitions.cpp",
        ("lines-signs", "a.factor * b.factor, std::move(less)", "1, std::move(less)", LINES),
        ("lines-offsets", "add_to(own.offset, next.offset, own.factor);", "", LINES),
    )
    | of(
        ROOM + "tiling/cones/lines.cpp",
        ("lines-price", "kPrice = 12", "kPrice = 0.5", LINES),
        ("lines-walk", "turned[via[v]] += n;", "turned[via[v]] -= n;", LINES),
        ("lines-jagged", "kMostTurned = 3", "kMostTurned = 300", LINES),
    )
    | of(ROOM + "tiling/cones/rounding.cpp", ("turned-sizes", "kOtherSize = 1;", "kOtherSize = 0;", TURNED))
    | of(ROOM + "tiling/cones/turned_map.cpp", ("cones-sum", "left != 0 && holes.empty()", "false", CHOSEN))
    | of(ROOM + "flat/island_layout.cpp", ("held-islands", "cos(5 *", "cos(150 *", DIRECTION))
    | of(ROOM + "tiling/cones/upright.cpp", ("upright-turns", "sine : sine;", "sine : -sine;", DIRECTION))
    | of(
        ROOM + "uv/direction.cpp",
        ("direction-steep", "kSteep = 0.35", "kSteep = 0.2", DIRECTION),
        ("direction-turns", "period = 360.0 / turns", "period = 180.0 / turns", DIRECTION),
    )
    | of(PACKAGE + "quality/quality.py", ("direction-slanted", "SLANTED = 25.0", "SLANTED = 20.0", DIRECTION))
    | of(ROOM + "tiling/cones/turned_space.cpp", ("lines-parts", "% 2 == 0 ? 1 : 0;", "% 2 == 0 ? 0 : 1;", LINES))
    | of(
        ROOM + "uv/turned_functions.cpp",
        ("unknowns-turn", "2 * b + 1, weight * turn.imag()", "2 * b + 1, -weight * turn.imag()", TURNED),
    )
    | of(ROOM + "uv/strain_energy.cpp", ("thin-triangles", "kThinArea = 1e-6", "kThinArea = 1e-2", THIN))
    | of(
        ROOM + "tiling/cones/carried_map.cpp",
        ("carried-cones", "cone.side = star(to);", "", CARRIED),
        ("carried-beside", "beside.side = CornerTable::previous(left);", "{}", CARRIED),
    )
    | of(
        ROOM + "choice/tiling_search.cpp",
        ("lines-asked", "kMirror || !edges", "kMirror && !edges", ASKED),
        ("most-lost", "!(lost < kMostLost)", "!(lost < 1)", AUTOMATIC),
        ("stretched-too-far", "factor <= kMostStretched)", "factor <= 9)", "native:TilingSearch*"),
        ("stretched-jumps", "std::abs((std::conj(line)", "0 * std::abs((std::conj(line)", "native:TilingSearch*"),
    )
    | of(ROOM + "choice/candidate.h", ("budget-nested", "budget_.depth_++ == 0", "++budget_.depth_", "native:Budget*"))
    | of(
        ROOM + "choice/side_by_side.cpp",
        ("first-error", "part_ < part) return", "part_ > part) return", "native:SideBySide*"),
        ("largest-first", "std::ranges::greater()", "std::ranges::less()", "native:SideBySide*"),
        ("crew-cancels", "return goes_on_.load();", "return true;", "native:*SideBySide*"),
    )
    | of(ROOM + "choice/size.cpp", ("window-middle", "-std::abs(std::log", "std::abs(std::log", "native:BestWindow*"))
    | of(ROOM + "choice/truncated.cpp", ("cut-off", "kCut = 1.0 / 3", "kCut = 2.0 / 3", "native:Truncated*"))
    | of(
        ROOM + "choice/piece_search.cpp",
        ("cones-of-pieces", "for (int& v : tiling.cones) v = vertex_index[v];", "", ASKED),
    )
    | of(
        ROOM + "choice/map.cpp",
        ("cones-cost", "tilings_) marks.cones +=", "tilings_) marks.cones *=", ASKED),
    )
    | of(PACKAGE + "batch/mapping.py", ("centre-of-turns", "+ np.array(found.centre) / images", "", GLB))
    | of(
        ROOM + "tiling/cones/turned_tiling.cpp",
        ("mirror-jumps", "low[1]) * std::conj(high[0]", "low[0]) * std::conj(high[1]", MIRRORED),
    )
    | of(ROOM + "mesh/mirror.cpp", ("mirror-side", "= following[at->second]", "= at->second", MIRRORED))
    | of(ROOM + "tiling/cones/turned_tiling.cpp", ("lines-ends", "kMostEnds = 0.02", "kMostEnds = 0.2", LINES))
)
