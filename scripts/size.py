"""python3 scripts/size.py: the lines of code and the types of each room; --lower writes them to scripts/size.toml.

A ceiling there is raised by hand alone, where another one goes down as far: "all" bounds their sum. Lines of code are
neither blank nor of a comment or a docstring.
"""

import ast
import io
import re
import sys
import tokenize
from collections import defaultdict
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[1]
CEILINGS = ROOT / "scripts" / "size.toml"
FOLDERS = {"native/src": (".cpp", ".h"), "native/holomorph": (".py",), "addon": (".py",)}
# Comments, and the strings and characters inside of which is none.
CPP = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.DOTALL)
CPP_TYPE = re.compile(r"^\s*(?:template\s*<[^;{]*>\s*)?(?:class|struct|enum)\s[^;()]*\{", re.MULTILINE)
NO_CODE = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}


def cpp_size(text):
    """(lines of code, types) of a text in C++."""
    code = CPP.sub(lambda found: found[0] if found[0][0] in "R\"'" else "\n" * found[0].count("\n"), text)
    return sum(bool(line.strip()) for line in code.splitlines()), len(CPP_TYPE.findall(code))


def python_size(text):
    """(lines of code, classes) of a text in Python."""
    nodes, lines = list(ast.walk(ast.parse(text))), set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in NO_CODE:
            lines.update(range(token.start[0], token.end[0] + 1))
    for node in nodes:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            lines.difference_update(range(node.lineno, node.end_lineno + 1))
    written = text.splitlines()
    return sum(bool(written[line - 1].strip()) for line in lines), sum(isinstance(node, ast.ClassDef) for node in nodes)


def sizes():
    """{room: (lines of code, types)}; a room is a folder of native/src, native/holomorph or addon, or one of these."""
    result = defaultdict(lambda: (0, 0))
    for folder, endings in FOLDERS.items():
        for path in sorted((ROOT / folder).rglob("*")):
            inside = path.relative_to(ROOT / folder).parts
            if path.suffix in endings and "lib" not in inside:
                size = (cpp_size if path.suffix != ".py" else python_size)(path.read_text(encoding="utf-8"))
                room = f"{folder}/{inside[0]}" if len(inside) > 1 else folder
                result[room] = tuple(map(sum, zip(result[room], size)))
    return dict(result)


def ceilings():
    """As `sizes`, with the sum of all under "all"."""
    return {room: tuple(size) for room, size in tomllib.loads(CEILINGS.read_text(encoding="utf-8")).items()}


def lowered(now, known):
    """The ceilings of these sizes: what was less remains, and a room that is gone has none."""
    total = tuple(map(sum, zip(*now.values())))
    return {room: tuple(map(min, known.get(room, size), size)) for room, size in {**now, "all": total}.items()}


if __name__ == "__main__":
    found = sizes()
    if "--lower" in sys.argv:
        text = [f'"{room}" = {list(size)}\n' for room, size in lowered(found, ceilings()).items()]
        CEILINGS.write_text("# Ceilings: [lines of code, types]. scripts/size.py explains them.\n" + "".join(text))
    for place, (count, types) in {**found, **lowered(found, {"all": ceilings()["all"]})}.items():
        print(f"{place:<28} {count:6} {types:4}")
