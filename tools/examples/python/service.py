"""How a Python service runs jobs: threads share the process (the GIL is released), each job is bounded, every failure
is caught by kind."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

import quadseg


def make_waves(n):
    x, y = np.meshgrid(np.linspace(0, 10, n), np.linspace(0, 10, n))
    vertices = np.stack([x, y, 0.3 * np.sin(x) * np.cos(y)], axis=-1).reshape(-1, 3)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    return vertices, faces.astype(np.uint32)


def serve(job):
    name, (vertices, faces), limits = job
    try:
        result = quadseg.segment(vertices, faces, threads=1, **limits)
        return name, "partial" if result.partial else "complete", f"{len(result.regions)} regions"
    except quadseg.OutOfMemory as error:
        return name, "refused", str(error)
    except quadseg.InputError as error:
        return name, "bad mesh", str(error)
    except quadseg.Error as error:
        return name, "failed", f"{error.code}: {error}"


small, large = make_waves(30), make_waves(250)
broken = (small[0], small[1] + 2000)
jobs = [
    ("small", small, {"timeout": 60}),
    ("hurried", large, {"timeout": 0.05}),
    ("narrow", large, {"memory_limit": 1 << 20}),
    ("broken", broken, {}),
]
with ThreadPoolExecutor(max_workers=2) as pool:
    answers = list(pool.map(serve, jobs))
for answer in answers:
    print(*answer, sep=": ")
assert [answer[1] for answer in answers] == ["complete", "partial", "refused", "bad mesh"], answers
