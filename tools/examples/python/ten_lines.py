"""Ten lines of Python segment a NumPy mesh: a box, six planes."""

import numpy as np

import quadseg

vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], dtype=float)
quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
faces = np.array([[a, b, c] for p, q, r, s in quads for a, b, c in ((p, q, r), (p, r, s))], dtype=np.uint32)
result = quadseg.segment(vertices, faces)
for region in result.regions:
    print(region.id, region.type, region.faces, region.parameters)
assert [region.type for region in result.regions] == ["plane"] * 6
