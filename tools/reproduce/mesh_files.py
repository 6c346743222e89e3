"""Reads and writes the few mesh files that the report handles itself; everything else is the program's business."""
import pathlib

import numpy as np

_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4", "double": "f8",
          "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8", "uint8": "u1", "int8": "i1"}


def _read_off(path):
    words = path.read_text().replace("OFF", "", 1).split()
    vertices, faces = int(words[0]), int(words[1])
    positions = np.array(words[3:3 + 3 * vertices], float).reshape(-1, 3)
    flat = np.array(words[3 + 3 * vertices:], float)[:4 * faces].reshape(-1, 4)
    if not (flat[:, 0] == 3).all():
        raise ValueError(f"{path}: not only triangles")
    return positions, flat[:, 1:].astype(np.int64)


def _read_obj(path):
    positions, triangles = [], []
    for line in path.read_text().splitlines():
        if line.startswith("v "):
            positions.append([float(x) for x in line.split()[1:4]])
        elif line.startswith("f "):
            triangles.append([int(word.split("/")[0]) - 1 for word in line.split()[1:4]])
    return np.array(positions), np.array(triangles, np.int64)


def _read_ply(path):
    """Binary, little endian, triangles without face properties beside those of the program."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    vertices = faces = 0
    element, vertex, face = "", [], []
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            element = words[1]
            vertices, faces = (int(words[2]), faces) if element == "vertex" else (vertices, int(words[2]))
        elif words[0] == "property" and element == "vertex":
            vertex.append((words[2], "<" + _TYPES[words[1]]))
        elif words[0] == "property" and words[1] == "list":
            face += [("count", "<" + _TYPES[words[2]]), ("corner", "<" + _TYPES[words[3]], (3,))]
        elif words[0] == "property":
            face.append((words[2], "<" + _TYPES[words[1]]))
    points = np.frombuffer(body, np.dtype(vertex), vertices)
    corners = np.frombuffer(body, np.dtype(face), faces, points.nbytes)
    return (np.stack([points[a].astype(float) for a in "xyz"], axis=1), corners["corner"].astype(np.int64))


def read(path):
    """Positions and triangles."""
    path = pathlib.Path(path)
    return {".off": _read_off, ".obj": _read_obj, ".ply": _read_ply}[path.suffix](path)


def write_off(path, positions, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(positions)} {len(triangles)} 0\n")
        np.savetxt(file, positions, fmt="%.17g")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), fmt="%d")


def centroids(positions, triangles):
    return positions[triangles].mean(axis=1)


def areas(positions, triangles):
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def joined(meshes):
    """Several meshes as one, and the number of its mesh for every triangle."""
    positions = np.concatenate([p for p, _ in meshes])
    starts = np.cumsum([0] + [len(p) for p, _ in meshes[:-1]])
    triangles = np.concatenate([t + start for (_, t), start in zip(meshes, starts)])
    return positions, triangles, np.concatenate([np.full(len(t), i) for i, (_, t) in enumerate(meshes)])
