"""Sampled quadrics for Fig. 11, and the surface f = 0 of ten coefficients as triangles."""
import numpy as np


def _grid(rows, columns, wrap):
    """Triangles of a grid of rows × columns cells; `wrap`: the last column meets the first."""
    width = columns if wrap else columns + 1
    i, j = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    right = (j + 1) % width
    a, b, c, d = (v.ravel() for v in (i * width + j, i * width + right, (i + 1) * width + right, (i + 1) * width + j))
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def elliptic_cylinder(cells):
    angle = np.arange(2 * cells) * np.pi / cells
    height, angle = np.meshgrid(np.linspace(-1, 1, cells + 1), angle, indexing="ij")
    positions = np.stack([np.cos(angle), 0.35 * np.sin(angle), height], -1).reshape(-1, 3)
    return positions, _grid(cells, 2 * cells, True)


def ellipsoid(cells):
    """Without its two poles, which a grid of squares would tear."""
    polar, angle = np.meshgrid(np.linspace(np.pi - 0.15, 0.15, cells + 1), np.arange(2 * cells) * np.pi / cells, indexing="ij")
    positions = np.stack([np.sin(polar) * np.cos(angle), 0.6 * np.sin(polar) * np.sin(angle), 0.35 * np.cos(polar)], -1)
    return positions.reshape(-1, 3), _grid(cells, 2 * cells, True)


def saddle(cells):
    y, x = np.meshgrid(np.linspace(-1, 1, cells + 1), np.linspace(-1, 1, cells + 1), indexing="ij")
    return np.stack([x, y, x * x - y * y], -1).reshape(-1, 3), _grid(cells, cells, False)


SHAPES = {"elliptic cylinder": elliptic_cylinder, "ellipsoid": ellipsoid, "saddle": saddle}

_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]])
_TETRAHEDRA = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def values(coefficients, points):
    x, y, z = np.moveaxis(points, -1, 0)
    monomials = (np.ones_like(x), x, y, z, x * x, x * y, x * z, y * y, y * z, z * z)
    return sum(c * m for c, m in zip(coefficients, monomials))


def zero_set(coefficients, low, high, cells=48):
    """Marching tetrahedra over a box: positions and triangles, corners not shared."""
    axes = [np.linspace(low[k], high[k], cells + 1) for k in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    f = values(coefficients, points)
    pieces = []
    for tetrahedron in _TETRAHEDRA:
        corner = [tuple(slice(o, o + cells) for o in _CORNERS[c]) for c in tetrahedron]
        p = np.stack([points[c].reshape(-1, 3) for c in corner], 1)
        v = np.stack([f[c].reshape(-1) for c in corner], 1)
        inside = v < 0
        for code in range(1, 15):
            chosen = (inside == [(code >> k) & 1 for k in range(4)]).all(axis=1)
            if not chosen.any():
                continue
            ins = [k for k in range(4) if code >> k & 1]
            outs = [k for k in range(4) if not code >> k & 1]
            cut = lambda a, b, q=p[chosen], w=v[chosen]: q[:, a] + (q[:, b] - q[:, a]) * (
                w[:, a] / (w[:, a] - w[:, b]))[:, None]
            if len(ins) == 2:
                a, b, c, d = cut(ins[0], outs[0]), cut(ins[0], outs[1]), cut(ins[1], outs[1]), cut(ins[1], outs[0])
                pieces += [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
            else:
                apex, others = (ins[0], outs) if len(ins) == 1 else (outs[0], ins)
                pieces.append(np.stack([cut(apex, o) for o in others], 1))
    if not pieces:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    corners = np.concatenate(pieces).reshape(-1, 3)
    return corners, np.arange(len(corners)).reshape(-1, 3)
