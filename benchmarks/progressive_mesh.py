# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/progressive_mesh.py [MESH ...] [--faces N ...] [--json FILE]

Faces per second of the progressive mesh, one thread, against OpenMesh's Decimater (quadrics, normal check, progressive
mesh records) and meshoptimizer (no records) in the same run: of the mesh files named, and of bumpy tori with about N
faces. Prints ratios and writes the seconds as JSON.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from meshes import bumpy_torus, write_ply
from programs import ROOT, program

# Width and digits of the columns.
KEYS = {"quadric": "9.2f", "independent": "12.2f", "restore": "8.2f", "openmesh": "9.3f"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--faces", nargs="*", type=int, default=[60_000, 250_000, 1_000_000])
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "progressive_mesh.json")
    arguments = parser.parse_args()
    measure = program("progressive_mesh")
    results = []
    with tempfile.TemporaryDirectory() as folder:
        tori = [write_ply(Path(folder) / f"torus_{faces}.ply", *bumpy_torus(faces)) for faces in arguments.faces]
        print(
            f"{'mesh':28} {'faces':>8} {'quadric':>9} {'independent':>12} {'restore':>8} {'OpenMesh':>9} "
            f"{'ratio':>6} {'meshoptimizer':>14} {'ratio':>6}"
        )
        print(f"{'':28} {'':>8} {'million faces per second':^42}")
        for mesh in [*arguments.meshes, *tori]:
            line = subprocess.run([measure, mesh], capture_output=True, text=True, check=True).stdout
            result = json.loads(line)
            results.append(result)
            speed = {key: result["faces"] / 1e6 / result[key] for key in KEYS}
            columns = " ".join(f"{speed[key]:{width}}" for key, width in KEYS.items())
            ratios = [result[key] / result["quadric"] for key in ("openmesh", "meshoptimizer")]
            fast = result["meshoptimizer_removed"] / 1e6 / result["meshoptimizer"]
            print(f"{result['mesh']:28} {result['faces']:8} {columns} {ratios[0]:6.1f} {fast:14.2f} {ratios[1]:6.2f}")
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    arguments.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
