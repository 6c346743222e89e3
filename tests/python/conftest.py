"""Meshes that the tests make themselves."""

import numpy as np
import pytest


def make_can(segments=48, rows=16):
    """A closed cylinder of radius 1 and height 3: three surfaces. Returns vertices (V, 3), faces (F, 3)."""
    angle = 2 * np.pi * np.arange(segments) / segments
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(segments)], axis=1)
    side = np.concatenate([ring + [0, 0, 3 * row / rows] for row in range(rows + 1)])
    vertices = np.concatenate([side, [[0, 0, 0], [0, 0, 3]]])
    s = np.arange(segments)
    after = (s + 1) % segments
    faces = []
    for row in range(rows):
        low, high = row * segments, (row + 1) * segments
        faces.append(np.stack([low + s, low + after, high + after], axis=1))
        faces.append(np.stack([low + s, high + after, high + s], axis=1))
    bottom, top = len(side), len(side) + 1
    faces.append(np.stack([np.full(segments, bottom), after, s], axis=1))
    faces.append(np.stack([np.full(segments, top), rows * segments + s, rows * segments + after], axis=1))
    return vertices, np.concatenate(faces).astype(np.uint32)


@pytest.fixture(scope="session")
def can():
    return make_can()


@pytest.fixture(scope="session")
def large():
    """Some 16,000 faces, waves: takes a second."""
    n = 90
    x, y = np.meshgrid(np.linspace(0, 10, n), np.linspace(0, 10, n))
    vertices = np.stack([x, y, 0.3 * np.sin(x) * np.cos(1.3 * y)], axis=-1).reshape(-1, 3)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    return vertices, faces.astype(np.uint32)
