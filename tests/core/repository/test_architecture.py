"""The rooms and the arrows between them: what includes or imports what, read from the sources."""

import ast
import re

from repository import ROOT, SUPPORT

NATIVE = ROOT / "native" / "src"
PUBLIC = ROOT / "native" / "include" / "holomorph"
FACADE = ROOT / "native" / "holomorph"
ADDON = ROOT / "addon"
IN_BLENDER = FACADE / "batch" / "in_blender.py"

# Each room of native/src, and the rooms that it may include directly or through them.
ROOM_BELOW = {
    "base": [],
    "linear": ["base"],
    "mesh": ["linear"],
    "tiles": ["mesh"],
    "progressive": ["mesh"],
    "openmesh": ["progressive"],
    "solver": ["linear"],
    "topology": ["progressive"],
    "forms": ["topology", "solver"],
    "moduli": ["forms"],
    "uv": ["forms"],
    "structure": ["uv"],
    "tiling": ["structure"],
    "flat": ["structure"],
    "choice": ["tiling", "flat", "tiles"],
    "bindings": ["moduli", "choice"],
}
# The rooms of the package, each of which imports only earlier ones. What lies in the package itself begins with all.
PACKAGE_ROOMS = (
    *("core", "files", "mesh", "quality", "packing", "tiling", "forms", "plane", "tiles", "maps", "moduli"),
    *("levels", "commands", "batch", ""),
)
# Each room of the add-on, and the rooms that it may import directly or through them. "" is what lies in addon itself.
ADDON_BELOW = {
    "": [],
    "solving": [""],
    "scene": ["solving"],
    "materials": ["scene"],
    "maps": ["scene"],
    "writing": ["materials"],
    "results": ["maps", "writing"],
    "baking": ["results"],
    "levels": ["results"],
    "things": ["results"],
    "overlays": ["results"],
    "operators": ["baking", "levels", "things", "overlays"],
    "interface": ["operators"],
}
ADDON_TOP = {ADDON / "__init__.py", ADDON / "headless.py"}  # they start the rooms
# One word for one thing: what is not said, and what is said instead.
WORDS = {
    r"punctur": "pole",
    r"\bleverage\b": "Jacobian",
    r"\blandscape\b": "pole basis",
    r"\bwishe[ds]\b": "options",
    r"(?:HalfEdges|EdgeEnds)&? mesh\b": "half_edges",
    r"boundary component": "boundary loop",
    r"cone singularit": "cone point",
    r"\b1-form": "one-form",
    r"\b(?:one|1)-ring\b": "star",
    r"parametri[sz]ation": "map",
    r"\bgiven ?mesh\b": "input",
}
BARE_OF = re.compile(r'^\s*(?://[/!]?|#|""")<?\s*Of\b', re.MULTILINE)  # a comment that begins so is not a sentence
BESIDE_ROOMS = {"automatic_map", "command_line", "files", "python", "repository"}  # in tests/core
COMMENTED = ("native/holomorph", "addon", "tests", "benchmarks", "blend_examples", "docs")
OWN_FOLDERS = ("native", "addon", "tests", "scripts", "docs", "benchmarks", "examples", "blend_examples")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef)
OTHERS_FILES = {"cholmod.h", "sysexits.h", "script.py", "program.cpp", "ops.py"}  # of other projects, or of readers
HEADER_LINES = 190
FILE_LINES = 400


def rooms_below(room, arrows=ROOM_BELOW):
    below = set(arrows[room])
    for lower in arrows[room]:
        below |= rooms_below(lower, arrows)
    return below


def cpp_files():
    return sorted([*NATIVE.rglob("*.h"), *NATIVE.rglob("*.cpp")])


def python_files(folder):
    return sorted(path for path in folder.rglob("*.py") if "lib" not in path.relative_to(folder).parts)


def identify(path):
    return str(path.relative_to(ROOT))


def includes(path):
    return re.findall(r'^\s*#\s*include\s*([<"][^>"]+[>"])', path.read_text(encoding="utf-8"), re.MULTILINE)


def imports(path):
    """Names imported anywhere in a file, with a leading dot for its own package's."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level:
            names |= {"." + node.module} if node.module else {"." + alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module)
    return names


def addon_room(path):
    return path.relative_to(ADDON).parent.name


def addon_imports(path, is_at_top=False):
    """The add-on's files that one of them imports, anywhere or where it is loaded."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return local_imports(path, tree.body if is_at_top else ast.walk(tree))


def local_imports(path, nodes):
    """Files that relative imports among the nodes of a file name."""
    found = []
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            names = [folder.with_suffix(".py")] if node.module else []
            names += [folder / f"{alias.name}.py" for alias in node.names]
            found += [name for name in names if name.is_file()]
    return sorted(set(found))


def packages_at_top(path):
    """Packages of others that a file imports where it is loaded."""
    nodes = ast.parse(path.read_text(encoding="utf-8")).body
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    return names + [node.module for node in nodes if isinstance(node, ast.ImportFrom) and not node.level]


def length(path):
    return len(path.read_text(encoding="utf-8").splitlines())


def test_includes_go_down():
    wrong = []
    for path in cpp_files():
        room = path.relative_to(NATIVE).parts[0]
        for include in includes(path):
            if not include.startswith('"'):
                continue
            name = include.strip('"')
            found = (
                (path.parent / name).exists() if "/" not in name else name.split("/")[0] in {room, *rooms_below(room)}
            )
            if not found:
                wrong.append(f"{identify(path)} includes {include}")
    assert not wrong


def test_files_have_no_circle():
    """A source and the header of its name are one unit, as the linker sees them."""
    unit = {path: str(path.relative_to(NATIVE).with_suffix("")) for path in cpp_files()}
    graph = {name: set() for name in unit.values()}
    for path, name in unit.items():
        targets = {include.strip('"').removesuffix(".h") for include in includes(path) if include.startswith('"')}
        graph[name] |= {target for target in targets if target in graph and target != name}
    done = set()

    def visit(name, trail):
        assert name not in trail, " -> ".join([*trail, name])
        if name not in done:
            for target in sorted(graph[name]):
                visit(target, [*trail, name])
            done.add(name)

    for name in graph:
        visit(name, [])


def test_public_headers_include_rooms_alone():
    """OpenMesh's meshes come in through holomorph/openmesh.h alone; no header that others read knows Python."""
    rooms = {path.stem: {include.strip('"').split("/")[0] for include in includes(path)} for path in PUBLIC.iterdir()}
    assert set(rooms) == {"holomorph", "openmesh"}
    assert rooms["openmesh"] == {"openmesh"}
    assert rooms["holomorph"] <= set(ROOM_BELOW) - {"bindings", "openmesh"}
    missing = {include for path in PUBLIC.iterdir() for include in includes(path)} - {
        f'"{path.relative_to(NATIVE)}"' for path in NATIVE.rglob("*.h")
    }
    assert not missing


def drawn_rooms():
    """{room: rooms below it} as CONTRIBUTING draws both pictures: a comma stands between rooms beside each other."""
    rows = re.findall(r"^    (.* <- .*)$", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE)
    arrows = {}
    for row in rows:
        groups = [group.split(", ") for group in row.split(" <- ")]
        for lower, upper in zip(groups, groups[1:]):
            for room in upper:
                arrows.setdefault(room, set()).update(lower)
        arrows |= {room: set() for room in groups[0] if room not in arrows}
    return {room: rooms_below(room, arrows) for room in arrows}


def test_the_pictures_of_the_rooms_show_the_tables():
    tables = [{room: rooms_below(room, table) - {""} for room in table if room} for table in (ROOM_BELOW, ADDON_BELOW)]
    assert drawn_rooms() == tables[0] | tables[1]
    assert ", ".join(PACKAGE_ROOMS).rstrip(", ") in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_files_that_are_named_are_there():
    """In comments, docstrings and pages, by a part of the path or the name alone."""
    named = re.compile(r"(?<![\w./<*-])(?:[a-z]\w*/)*[a-z]\w*\.(?:h|cpp|py)\b(?![.(])")
    own = [path for name in OWN_FOLDERS for path in (ROOT / name).rglob("*") if "lib" not in path.parts]
    there = {f"/{identify(path)}" for path in own}
    wrong = []
    for path in [*own, *ROOT.glob("*.md")]:
        if path.suffix in {".h", ".cpp", ".py", ".md"} and path.name != "CHANGELOG.md":
            found = {name for name in named.findall(written(path)) if "NAME" not in name} - OTHERS_FILES
            wrong += [
                f"{identify(path)} names {name}" for name in found if not any(p.endswith(f"/{name}") for p in there)
            ]
    assert not wrong


def written(path):
    """What a file says in words: a page without its blocks of code, comments and docstrings."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    if path.suffix == ".py":
        docs = [ast.get_docstring(node) for node in ast.walk(ast.parse(text)) if isinstance(node, DOCUMENTED)]
        return "\n".join([*filter(None, docs), *re.findall(r"(?m)(?:^|\s)# .*", text)])
    return "\n".join(re.findall(r"(?m)(?:^|\s)//.*", text))


def test_all_rooms_are_installed():
    text = (ROOT / "native" / "library.cmake").read_text(encoding="utf-8")
    rooms = " ".join(re.findall(r"(?:^set\(|list\(APPEND )rooms\s([\w\s]+)\)", text, re.MULTILINE))
    assert sorted(rooms.split()) == sorted(set(ROOM_BELOW) - {"bindings"})


def test_each_source_has_its_header():
    """Bindings are declared together: each defines one function."""
    sources = [path for path in cpp_files() if path.suffix == ".cpp" and path.parent.name != "bindings"]
    assert not [identify(path) for path in sources if not path.with_suffix(".h").exists()]


def test_only_bindings_know_python_and_only_mesh_io_knows_files():
    wrong = []
    for path in cpp_files():
        relative = path.relative_to(NATIVE)
        headers = {include.strip('<>"') for include in includes(path)}
        forbidden = {"iostream", "ctime"}
        if relative.parts[:2] != ("mesh", "io"):
            forbidden |= {"fstream", "cstdio"}
        if relative.parts[0] != "bindings":
            forbidden |= {name for name in headers if name.startswith("pybind11") or name == "Python.h"}
        wrong += [f"{identify(path)} includes {name}" for name in sorted(headers & forbidden)]
    assert not wrong


def test_nothing_prints_ends_the_process_or_depends_on_chance():
    """A seeded engine gives the same numbers everywhere; the library's distributions differ between compilers."""
    call = re.compile(r"\b(?:printf|puts|perror|rand|srand|abort|exit|terminate)\s*\(|random_device|_distribution\b")
    assert not [identify(path) for path in cpp_files() if call.search(path.read_text(encoding="utf-8"))]


def test_targets_link_downwards_and_name_every_source():
    text = (ROOT / "native" / "CMakeLists.txt").read_text(encoding="utf-8")
    rooms = re.findall(r"^holomorph_room\((\w+)(.*?)\)", text, re.MULTILINE | re.DOTALL)
    assert {name for name, _ in rooms} == {path.name for path in NATIVE.iterdir() if path.name != "bindings"}
    named = set(re.findall(r"src/(bindings/[\w/]+\.cpp)", text))
    for name, body in rooms:
        named |= {f"{name}/{source}" for source in re.findall(r"[\w/]+\.cpp", body)}
        assert set(re.findall(r"\bholomorph_(\w+)", body)) & set(ROOM_BELOW) <= rooms_below(name)
    assert named == {str(path.relative_to(NATIVE)) for path in NATIVE.rglob("*.cpp")}


def test_the_package_knows_nothing_of_blender():
    """But for the script that Blender runs in a process of its own, which no other file imports."""
    blender = {"bpy", "bmesh", "mathutils", "gpu", "gpu_extras", "bl_ui", "addon"}
    files = [path for path in python_files(FACADE) if path != IN_BLENDER]
    wrong = {identify(path): {name.split(".")[0] for name in imports(path)} & blender for path in files}
    assert not {path: names for path, names in wrong.items() if names}
    assert not [identify(path) for path in files if any(IN_BLENDER.stem in name for name in imports(path))]


def package_room(path):
    return path.relative_to(FACADE).parts[0] if path.parent != FACADE else ""


def test_package_rooms_are_listed():
    assert {package_room(path) for path in python_files(FACADE)} == set(PACKAGE_ROOMS)


def test_package_imports_go_down():
    wrong = []
    for path in python_files(FACADE):
        room = PACKAGE_ROOMS.index(package_room(path))
        for name in local_imports(path, ast.walk(ast.parse(path.read_text(encoding="utf-8")))):
            if PACKAGE_ROOMS.index(package_room(name)) > room:
                wrong.append(f"{identify(path)} imports {identify(name)}")
    assert not wrong


def test_addon_rooms_are_listed():
    assert {addon_room(path) for path in python_files(ADDON)} == set(ADDON_BELOW)


def test_addon_imports_go_down():
    wrong = []
    for path in set(python_files(ADDON)) - ADDON_TOP:
        allowed = {addon_room(path), *rooms_below(addon_room(path), ADDON_BELOW)}
        targets = addon_imports(path)
        wrong += [f"{identify(path)} imports {identify(name)}" for name in targets if addon_room(name) not in allowed]
        wrong += [f"{identify(path)} imports {identify(name)}" for name in ADDON_TOP & set(targets)]
    assert not wrong


def test_addon_imports_have_no_circle():
    done = set()

    def visit(path, trail):
        assert path not in trail, " -> ".join(map(identify, [*trail, path]))
        if path not in done:
            for target in addon_imports(path):
                visit(target, [*trail, path])
            done.add(path)

    for path in python_files(ADDON):
        visit(path, [])


def test_what_runs_in_threads_knows_nothing_of_blender():
    """Each `jobs.Work`, and what follows a solve."""
    works = [path for path in python_files(ADDON) if re.search(r"\(jobs\.Work\)", path.read_text("utf-8"))]
    files = [*works, *(ADDON / "solving").glob("*.py"), ADDON / "maps" / "mapped.py"]
    assert len(works) > 1 and not [identify(path) for path in files if imports(path) & {"bpy", "bmesh", "mathutils"}]


def loaded_at_registration():
    return imported_at_the_top(ADDON / "__init__.py")


def test_registration_loads_neither_numpy_nor_the_core():
    """Blender starts, and the panel says what is missing, without them."""
    loaded = loaded_at_registration()
    assert len(loaded) > len(ADDON_BELOW)
    assert not [identify(path) for path in loaded if {"numpy", "holomorph"} & set(packages_at_top(path))]


def imported_at_the_top(*paths):
    """These files and all that they load, one through the other."""
    loaded, waiting = set(), list(paths)
    while waiting:
        path = waiting.pop()
        if path not in loaded:
            loaded.add(path)
            waiting += addon_imports(path, is_at_top=True)
    return loaded


def test_what_needs_no_package_does_not_load_it():
    """Where the native part is missing, maps are removed, materials brought back and meshes repaired all the same."""
    loading = {
        path for path in python_files(ADDON) if re.search(r"^\w+ = module\(", path.read_text("utf-8"), re.MULTILINE)
    }
    assert loading == {ADDON / "solving" / "jobs.py"}
    names = ("results/restore", "results/repair", "materials/nodes", "materials/material", "writing/transaction")
    assert not loading & imported_at_the_top(*(ADDON / f"{name}.py" for name in names))


def test_others_import_at_the_top():
    """Only what registration loads imports inside functions: what would load NumPy or the core."""
    others = set(python_files(ADDON)) - loaded_at_registration()
    assert not [identify(path) for path in others if addon_imports(path) != addon_imports(path, is_at_top=True)]


def test_only_these_touch_arrays_of_blender():
    touching = {path.stem for path in python_files(ADDON) if re.search(r"\bforeach_[gs]et\b", path.read_text("utf-8"))}
    assert touching <= {"mesh_io", "image_io"}


def test_nothing_makes_the_scene_the_owner_of_the_context():
    """Blender 3.4 to 4.5 note the scene in `bpy.context` where one of these is read. When that scene is gone, setting
    `bpy.context.window.scene`, as the exporter of glTF does, tags what then lies in its memory as changed."""
    noting = re.compile(r"\bcontext\.(tool_settings|layer_collection)\b")
    files = [path for name in ("addon", "tests", "blend_examples") for path in python_files(ROOT / name)]
    assert not [identify(path) for path in files if noting.search(path.read_text("utf-8"))]


def test_no_loop_is_over_objects_of_a_view_layer_that_is_not_up_to_date():
    """Where objects were removed Blender ends: `compatibility.objects_in` brings it up to date."""
    bare = re.compile(r'\blayer\.objects\b(?!\.active|, "active")')
    assert [identify(p) for p in python_files(ADDON) if bare.search(p.read_text())] == ["addon/compatibility.py"]


def test_nothing_writes_into_copies_of_a_mesh():
    """In Blender 4.0 to 5.0 `foreach_set` on `layer.uv` changes the UV map of the copies of the mesh, too."""
    writing = re.compile(r"layers?(\[[^]]*\])?(\.active)?\.uv[,.)]")
    files = [path for name in ("addon", "tests", "blend_examples", "docs") for path in python_files(ROOT / name)]
    assert not [identify(path) for path in files if writing.search(path.read_text("utf-8"))]


def test_tests_lie_in_the_room_of_what_they_test():
    for suite, ending, others in (("core", "py", BESIDE_ROOMS), ("native", "cpp", {"native"})):
        files = (ROOT / "tests" / suite).rglob(f"test_*.{ending}")
        assert not [identify(path) for path in files if path.parent.name not in {*ROOM_BELOW, *others}]


def test_tests_share_what_is_in_support():
    """No test imports from another, nor does a program within a test; what they share knows of no suite."""
    test = re.compile(r"^\s*(?:from|import) test_", re.MULTILINE)
    assert not [identify(path) for path in python_files(ROOT / "tests") if test.search(path.read_text("utf-8"))]
    assert not [identify(path) for path in python_files(SUPPORT) if "conftest" in imports(path)]


def test_no_file_is_long():
    """A small file joins its one user; what has become long is two things."""
    headers = {*NATIVE.rglob("*.h"), *PUBLIC.iterdir()}
    files = [*headers, *cpp_files(), *python_files(FACADE), *python_files(ADDON)]
    most = {path: HEADER_LINES if path in headers else FILE_LINES for path in files}
    assert not {identify(path): length(path) for path in files if length(path) > most[path]}


def test_one_thing_has_one_word():
    wrong = []
    for path in [*cpp_files(), *python_files(FACADE), *python_files(ADDON)]:
        text = path.read_text(encoding="utf-8")
        wrong += [f"{identify(path)}: {word}" for said, word in WORDS.items() if re.search(said, text, re.IGNORECASE)]
    assert not wrong


def test_comments_say_what_is_there():
    files = [*cpp_files(), *(path for name in COMMENTED for path in python_files(ROOT / name))]
    assert not [identify(path) for path in files if BARE_OF.search(path.read_text(encoding="utf-8"))]


def test_nothing_is_left_for_later():
    mark = re.compile(r"\b(?:TODO|FIXME|XXX|HACK)\b")
    files = [*cpp_files(), *python_files(FACADE), *python_files(ADDON)]
    assert not [identify(path) for path in files if mark.search(path.read_text(encoding="utf-8"))]


def test_sources_are_in_the_bibliography():
    known = set(re.findall(r"doi = \{([^}]+)\}", (ROOT / "docs" / "bibliography.bib").read_text(encoding="utf-8")))
    cited = {
        doi.rstrip(".,;:")
        for path in [*cpp_files(), *python_files(FACADE), *python_files(ADDON)]
        for doi in re.findall(r"doi:(10\.\d+/[^\s(),;]*(?:\(\d+\)[^\s(),;]*)?)", path.read_text(encoding="utf-8"))
    }
    assert cited and cited <= known, cited - known


# What begins a line at the scope of a namespace: a type, a function, or constants.
TYPE_OR_FUNCTION = re.compile(
    r"^(?=[A-Za-z\[])(?:(?:struct|class|enum class|enum) (\w+)(?: final)?\b(?=[^;(]*[{:])"
    r"|(?!using|namespace|return|template|typedef|struct|class|enum)(?:\[\[\w+\]\] )*[\w:<>,&*\[\] ]*?[ &*>](\w+)\()",
    re.MULTILINE,
)
CONSTANTS = re.compile(r"^(?:inline )?(?:constexpr|const) (?![^=;{]*\()([^;]*);", re.MULTILINE)
UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)


def names_of(text):
    text = re.sub(r"//[^\n]*", "", text)
    names = {one or other for one, other in TYPE_OR_FUNCTION.findall(text)}
    return names.union(
        *(re.findall(r"\b(k[A-Z]\w*)(?=\s*(?:\[[^\]]*\])?\s*[={])", one) for one in CONSTANTS.findall(text))
    )


def test_files_of_a_room_can_be_compiled_as_one():
    """A name in an unnamed namespace hides the same name of a header, without a word, from the files that follow."""
    shared = {room: set() for room in ROOM_BELOW}
    hidden = {room: [] for room in ROOM_BELOW}
    for path in sorted(NATIVE.rglob("*.[hc]*")):
        room, text = path.relative_to(NATIVE).parts[0], path.read_text()
        if path.suffix == ".h":
            shared[room] |= names_of(text)
        else:
            hidden[room] += names_of("".join(UNNAMED.findall(text)))
    assert sum(map(len, hidden.values())) > 1000  # or the patterns find nothing
    for room, names in hidden.items():
        twice = {name for name in names if names.count(name) > 1 or name in shared[room] | shared["base"]}
        assert not twice, (room, twice)
