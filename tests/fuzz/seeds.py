#!/usr/bin/env python3
"""Small valid files of every format and recipes of every kind, for the fuzz targets to begin with.

    seeds.py FOLDER [MESH.off ...]

makes FOLDER/<target>/ for each target. The first faces of any given text OFF files are written in all formats too.
"""

import random
import struct
import sys
from pathlib import Path

CUBE = (
    [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)],
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
)
TETRAHEDRON = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
PENTAGON = ([(0, 0, 0), (2, 0, 0), (3, 2, 0), (1, 1, 0.5), (-1, 2, 0)], [(0, 1, 2, 3, 4)])


def number(x):
    return f"{x:.7g}"


def line(values):
    return " ".join(number(x) for x in values) + "\n"


def off(vertices, faces, header="OFF\n", after=""):
    text = header + f"{len(vertices)} {len(faces)} 0\n"
    text += "".join(line(v) for v in vertices)
    return text + "".join(f"{len(f)} " + " ".join(map(str, f)) + after + "\n" for f in faces)


def obj(vertices, faces, corner="{0}", head=""):
    text = head + "".join("v " + line(v) for v in vertices)
    return text + "".join("f " + " ".join(corner.format(i + 1, i - len(vertices)) for i in f) + "\n" for f in faces)


def corners(vertices, faces):
    for f in faces:
        for i in range(1, len(f) - 1):
            yield [vertices[f[0]], vertices[f[i]], vertices[f[i + 1]]]


def stl_text(vertices, faces):
    text = "solid part\n"
    for triangle in corners(vertices, faces):
        text += "facet normal 0 0 1\nouter loop\n"
        text += "".join("vertex " + line(v) for v in triangle) + "endloop\nendfacet\n"
    return text + "endsolid part\n"


def stl_binary(vertices, faces):
    triangles = list(corners(vertices, faces))
    body = b"".join(struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *v) for v in t) + b"\0\0" for t in triangles)
    return b"binary".ljust(80, b"\0") + struct.pack("<I", len(triangles)) + body


def ply(vertices, faces, form, coordinate="float", more="", end="\n"):
    order = ">" if "big" in form else "<"
    code = {"float": "f", "double": "d", "short": "h"}[coordinate]
    head = f"ply\nformat {form} 1.0\ncomment seed\nelement vertex {len(vertices)}\n"
    head += "".join(f"property {coordinate} {axis}\n" for axis in "xyz")
    head += "property uchar red\n" * bool(more) + f"element face {len(faces)}\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    head = head.replace("\n", end)
    if form == "ascii":
        extra = " 255" if more else ""
        body = "".join(line(v)[:-1] + extra + end for v in vertices)
        return (head + body + "".join(f"{len(f)} " + " ".join(map(str, f)) + end for f in faces)).encode()
    rounded = [[int(x) if code == "h" else x for x in v] for v in vertices]
    body = b"".join(struct.pack(order + "3" + code, *v) + b"\xff" * bool(more) for v in rounded)
    return head.encode() + body + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


def reader_seeds(meshes):
    seeds = {"off": [], "obj": [], "stl": [], "ply": []}
    for mesh in meshes:
        seeds["off"] += [off(*mesh), off(*mesh, header="COFF # colours\n", after=" 0.5 1 0"), off(*mesh, header="")]
        seeds["off"] += [off(*mesh).replace("\n", "\r\n")]
        seeds["obj"] += [obj(*mesh), obj(*mesh, "{0}/{0}/{0}", "mtllib a\no b\n"), obj(*mesh, "{1}//{0}", "# c\n")]
        seeds["stl"] += [stl_text(*mesh), stl_binary(*mesh), stl_text(*mesh).upper()]
        for form in ("ascii", "binary_little_endian", "binary_big_endian"):
            seeds["ply"] += [ply(*mesh, form), ply(*mesh, form, "double", "red"), ply(*mesh, form, "short")]
            seeds["ply"].append(ply(*mesh, form, end="\r\n"))
    return {name: [s.encode() if isinstance(s, str) else s for s in some] for name, some in seeds.items()}


def off_faces(path, count):
    """The first `count` faces of a text OFF file, their vertices numbered anew."""
    words = path.read_text(errors="replace").split()
    vertex_count, face_count = int(words[1]), int(words[2])
    at = 4 + 3 * vertex_count
    faces = []
    for _ in range(min(count, face_count)):
        size = int(words[at])
        faces.append([int(i) for i in words[at + 1 : at + 1 + size]])
        at += 1 + size
    used = sorted({i for f in faces for i in f})
    vertices = [tuple(float(x) for x in words[4 + 3 * i : 7 + 3 * i]) for i in used]
    place = {i: k for k, i in enumerate(used)}
    return vertices, [[place[i] for i in f] for f in faces]


def recipes():
    """Bytes for segment_recipe.h: beginnings of every kind of option and shape, then anything."""
    generator = random.Random(7)
    for _ in range(600):
        size = generator.choice((12, 24, 40, 80, 200, 500))
        yield bytes(generator.randrange(256) for _ in range(size))
    for option in range(8):
        for shape in range(12):
            # Few options: kind, region count, no feature angle, no smoothing, ...; then shape and its sizes.
            yield bytes([option, 5, 0, 0, 0, 0, 0, 0, shape, 7, 3, 0, 0, 0, 0])


def main():
    folder = Path(sys.argv[1])
    meshes = [TETRAHEDRON, CUBE, PENTAGON] + [off_faces(Path(p), 20) for p in sys.argv[2:]]
    seeds = {f"read_{name}": some for name, some in reader_seeds(meshes).items()}
    seeds["read_any"] = [s for some in list(seeds.values()) for s in some]
    seeds["segment_shapes"] = seeds["segment_threads"] = list(recipes())
    for target, some in seeds.items():
        (folder / target).mkdir(parents=True, exist_ok=True)
        for i, seed in enumerate(some):
            (folder / target / f"seed{i:03}").write_bytes(seed)


if __name__ == "__main__":
    main()
