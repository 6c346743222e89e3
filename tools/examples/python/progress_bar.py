"""A progress bar around a call; Ctrl-C stops it at once. Usage: progress_bar.py [MESH]"""

import sys

import numpy as np

import quadseg

try:
    from tqdm import tqdm
except ImportError:
    sys.exit("this example needs tqdm")

if len(sys.argv) > 1:
    mesh = quadseg.read(sys.argv[1])
    vertices, faces = mesh.vertices, mesh.faces
else:
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    vertices = np.concatenate([np.stack([np.cos(angle), np.sin(angle), np.full(200, z)], 1) for z in range(20)])
    i = (np.arange(19)[:, None] * 200 + np.arange(200)).ravel()
    j = (np.arange(19)[:, None] * 200 + (np.arange(200) + 1) % 200).ravel()
    faces = np.concatenate([np.stack([i, j, j + 200], 1), np.stack([i, j + 200, i + 200], 1)]).astype(np.uint32)

with tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}") as bar:

    def show(progress):
        bar.set_postfix_str(f"{progress.phase}, {progress.regions} regions", refresh=False)
        bar.update(progress.fraction - bar.n)

    result = quadseg.segment(vertices, faces, progress=show)
print(result)
assert len(result.regions) >= 1
