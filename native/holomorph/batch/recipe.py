"""What a batch makes of each asset: a TOML file whose names are those of the Python API and of the operators."""

import difflib
import json
import math
import os
import re
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cached_property
from itertools import accumulate
from pathlib import Path

import tomllib

from ..core.value import quoted, shortened
from ..files import formats, textures, whole_file
from ..mesh.checks import SOLVERS, as_float
from ..tiling import request
from ..tiling.request import AUTO, AUTOMATIC, EVENNESS, LINED_TURNS, LINES, MAIN_MAPS, TURNS
from . import UsageError, mapping

BOUNDARIES = ("natural", "double_cover", "free")
FORMATS = ("npz", *formats.WRITERS, "blend")
MOST_BYTES = 2**18  # of a recipe
MOST_NESTED = 8  # lists and tables in each other, parts of a name
MOST_LEVELS, MOST_ENTRIES = 64, 1000  # of a list
IN_QUOTES = re.compile(r'"""(?:[^\\]|\\.)*?"""|"(?:[^"\\\n]|\\.)*"|' + r"'''.*?'''|'[^'\n]*'|#[^\n]*", re.DOTALL)
LONG_NAME = re.compile(rf"(?<![\w-])(?:[\w-]++[ \t]*+\.[ \t]*+){{{MOST_NESTED}}}")  # in time linear in the text


def _option(default, wanted, is_valid):
    return field(default=default, metadata={"wanted": wanted, "is_valid": is_valid})


def _one_of(names, default):
    return _option(default, f"one of {', '.join(names)}", lambda value: isinstance(value, str) and value in names)


def _number(default, wanted, is_valid=lambda value: True):
    return _option(default, wanted, lambda value: _is_number(value) and is_valid(value))


def _flag(default):
    return _option(default, "true or false", lambda value: isinstance(value, bool))


def _vertices(wanted, is_size=lambda size: True):
    return _option((), wanted, lambda value: _is_list(value, _is_count) and is_size(len(value)))


def _is_number(value):
    return not isinstance(value, bool) and math.isfinite(as_float(value))


def _is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**31


def _is_list(value, is_entry):
    return isinstance(value, list) and len(value) <= MOST_ENTRIES and all(is_entry(entry) for entry in value)


def _is_complex(value):
    return _is_number(value) or (_is_list(value, _is_number) and len(value) == 2)


@dataclass(frozen=True)
class Maps:
    """What the structures of the parts are, and how their maps lie in the UV plane."""

    main: str = _one_of(MAIN_MAPS, "automatic")
    forms: int = _option(0, "a whole number of at least 0", _is_count)  # maps of single forms, at most
    boundary: str = _one_of(BOUNDARIES, "natural")
    solver: str = _one_of(SOLVERS, "auto")
    thresholds: tuple | None = _option(
        None, "a list of numbers of faces", lambda v: _is_list(v, _is_count) and 0 not in v
    )
    poles: tuple = _vertices("a list of vertices")
    residues: tuple = _option((), "a list of numbers or of pairs [real, imaginary]", lambda v: _is_list(v, _is_complex))
    rectangle_corners: tuple = _vertices("a list of four vertices", lambda size: size == 4)
    cut_at_seams: bool = _flag(False)  # along seams of .blend files
    shape: bool = _flag(False)  # the maps to the sphere and the disk
    density: float = _number(1.0, "a positive number", lambda value: value > 0)
    margin: float = _number(0.02, "a number from 0 to 1", lambda value: 0 <= value < 1)
    rotation: float = _number(0.0, "an angle in degrees")
    memory_limit: int | None = _number(None, "a positive number of bytes", lambda v: 1 <= v < 2**63 and v == int(v))


@dataclass(frozen=True)
class Tiles:
    """Options of `Structure.tile` and of the operator *Seamless Tiling*."""

    tiles: float = _number(0.0, "a number of tiles or 0", lambda value: value >= 0)
    density: float | None = _number(None, "a positive number of tiles per unit of area", lambda value: value > 0)
    poles: object = _option(
        "auto",
        f'"auto", a number up to {request.MOST_POLES} or a list of vertices',
        lambda v: v == "auto" or (_is_count(v) and v <= request.MOST_POLES) or _is_list(v, _is_count),
    )
    lattice: str = _one_of(tuple(request.LATTICES), "square")
    direction: str | tuple = _option(
        "upright",
        '"upright", "none" or a list of three numbers that are not all 0',
        lambda v: v in ("upright", "none") or (_is_list(v, _is_number) and len(v) == 3 and any(v)),
    )
    boundary: str = _one_of(request.BOUNDARIES, "automatic")
    turn: float | None = _number(None, "an angle in radians", lambda value: True)
    max_turn: float = _number(0.2, "an angle of at least 0 radians", lambda value: value >= 0)
    evenness: float = _number(EVENNESS, "a number from 0 to 1", lambda value: 0 <= value <= 1)
    max_added: float | None = _number(None, "an angle distortion of at least 1", lambda value: value >= 1)
    turns: int | str = _option(1, f'1, 2, 4, 6 or "{AUTO}"', lambda v: v == AUTO or (_is_count(v) and v in TURNS))
    lines: str = _one_of((AUTOMATIC, *LINES), AUTOMATIC)  # at which rows end, or along which they run


@dataclass(frozen=True)
class Levels:
    """Options of the operator *Levels of Detail*."""

    levels: int = _option(0, f"a whole number from 0 to {MOST_LEVELS}", lambda v: _is_count(v) and v <= MOST_LEVELS)
    ratio: float = _number(0.25, "a number between 0 and 1", lambda value: 0 < value < 1)


@dataclass(frozen=True)
class Output:
    """The files of each asset, besides its report and its picture."""

    formats: tuple = _option(
        ("npz",), f"a list of {', '.join(FORMATS)}", lambda value: _is_list(value, FORMATS.__contains__)
    )
    # It is on the meshes of glb files.
    texture: str | None = _option(None, '"checker" or a PNG or JPEG file', lambda value: isinstance(value, str))
    up: str | None = _option(None, '"Y" or "Z"', lambda value: value in ("Y", "Z"))  # of mesh files; OBJ Y, others Z


@dataclass(frozen=True)
class Recipe:
    """All options; a table of the TOML file for each field."""

    maps: Maps = field(default_factory=Maps)
    tiling: Tiles = field(default_factory=Tiles)
    levels: Levels = field(default_factory=Levels)
    output: Output = field(default_factory=Output)

    @cached_property
    def canonical(self):
        """The same text for the same options and the same texture, whatever the files look like."""
        options, texture = asdict(self), self.output.texture
        options["output"]["texture"] = None if texture is None else textures.digest(texture)
        return json.dumps(options, sort_keys=True)


def read(path):
    """The `Recipe` of a TOML file; a texture's path starts at its folder. @throws UsageError"""
    try:
        text = whole_file.read(path, MOST_BYTES).decode()
        if _is_deep(text):  # before it takes time and stack to find out
            raise UsageError(f"{path}: lists, tables or names are nested more than {MOST_NESTED} deep")
        content = tomllib.loads(text)
    except OSError as error:
        raise UsageError(f"{path}: the recipe cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:  # besides those of TOML, those of UTF-8 and of numbers
        raise UsageError(f"{path}: this is not TOML: {shortened(str(error))}") from error
    try:
        recipe = of(content)
        recipe = replace(recipe, output=_with_texture(recipe.output, Path(path).resolve().parent))
        mapping.turned(recipe)  # before there is work
        return recipe
    except OSError as error:
        raise UsageError(f"{path}: {os.fsdecode(error.filename)}: {error.strerror}") from error
    except (UsageError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from error


def _is_deep(text):
    plain = IN_QUOTES.sub("x", text)
    depths = accumulate(1 if character in "[{" else -1 for character in plain if character in "[]{}")
    return max(depths, default=0) > MOST_NESTED or LONG_NAME.search(plain) is not None


def _with_texture(output, folder):
    """@throws ValueError, OSError where there is no such texture"""
    if output.texture in (None, textures.CHECKER):
        return output
    textures.check(folder / output.texture)
    return replace(output, texture=str(folder / output.texture))


def of(content):
    """The `Recipe` of a dictionary of tables. @throws UsageError"""
    kinds = {entry.name: entry.default_factory for entry in fields(Recipe)}
    _check_names(content, kinds, "table")
    tables = {name: _table(name, kinds[name], values) for name, values in content.items()}
    recipe = Recipe(**tables)
    _check_together(recipe)
    return recipe


def _table(name, kind, values):
    if not isinstance(values, dict):
        raise UsageError(f"{name} is {quoted(values)}; a table [{name}] is needed")
    known = {entry.name: entry for entry in fields(kind)}
    _check_names(values, known, f"key of [{name}]")
    for key, value in values.items():
        if not known[key].metadata["is_valid"](value):
            raise UsageError(f"{name}.{key} is {quoted(value)}; {known[key].metadata['wanted']} is needed")
    return kind(**{key: tuple(value) if isinstance(value, list) else value for key, value in values.items()})


def _check_names(given, known, noun):
    for name in given:
        if name not in known:
            near = difflib.get_close_matches(shortened(name), known, 1)
            hint = f"; did you mean {near[0]}?" if near else f"; use one of {', '.join(known)}"
            raise UsageError(f"{shortened(name)} is not a {noun}{hint}")


def _check_together(recipe):
    if recipe.maps.poles and recipe.maps.rectangle_corners:
        raise UsageError("maps.poles and maps.rectangle_corners cannot be combined")
    if recipe.maps.thresholds is not None and recipe.maps.solver != "paper":
        raise UsageError('maps.thresholds need maps.solver = "paper"')
    if recipe.maps.residues and len(recipe.maps.residues) != len(recipe.maps.poles):
        raise UsageError("maps.residues and maps.poles differ in length")
    if recipe.output.texture is not None and not set(formats.TEXTURED) & set(recipe.output.formats):
        raise UsageError(f"output.texture needs one of output.formats to be {' or '.join(formats.TEXTURED)}")
    if recipe.tiling.lines not in (AUTOMATIC, "none") and recipe.tiling.turns not in (*LINED_TURNS, AUTO):
        raise UsageError(f'tiling.lines = "{recipe.tiling.lines}" needs tiling.turns = 2, 4 or "{AUTO}"')
    if recipe.tiling.density is not None and recipe.tiling.tiles:
        raise UsageError("tiling.density and tiling.tiles cannot be combined")
