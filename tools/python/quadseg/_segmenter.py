"""One prepared mesh, many runs and steps."""

from __future__ import annotations

from typing import Any, Optional, Tuple

import numpy as np

from . import _arrays, _native
from ._api import ProgressFunction, _check_progress, _options, _segmentation
from ._types import Segmentation


class Segmenter:
    """Holds a checked mesh and its current partition, at first one region a connected component.

    Faces are named by index, regions by their label, 0 … regions - 1 after every operation. Operations that fail or are
    stopped (Ctrl-C, ``timeout``, ``progress``) raise and change nothing, but :meth:`run`, which then keeps its best
    partial result. One thread at a time. The GIL is released while an operation works.

    Parameters
    ----------
    vertices, faces, polygons : arrays
        As for :func:`segment`; they may go afterwards.
    progress, timeout, threads
        Of this preparation, as for :func:`segment`.
    **options
        Those of :func:`segment`: ``preset``, ``regions``, ``feature_angle`` …
    """

    def __init__(
        self,
        vertices: Any,
        faces: Any,
        *,
        polygons: Any = None,
        progress: Optional[ProgressFunction] = None,
        timeout: Optional[float] = None,
        threads: int = 0,
        **options: Any,
    ) -> None:
        vertices = _arrays.vertices_of(vertices)
        faces = _arrays.faces_of(faces)
        _check_progress(progress)
        self._faces = len(faces)
        self._native = _native.Segmenter(
            vertices, faces, _arrays.polygons_of(polygons, len(faces)), _options(options), progress, timeout, threads
        )

    @property
    def regions(self) -> int:
        """How many there are."""
        return self._native.regions()

    @property
    def labels(self) -> np.ndarray:
        """(F,) int32, a copy."""
        return self._native.labels()

    def set_options(self, *, threads: int = 0, **options: Any) -> None:
        """Options of :func:`segment` for what follows; those not named have their defaults again.

        The partition stays and is fitted anew, the mesh is not prepared again; forgets what could be undone.
        """
        self._native.set_options(_options(options), threads)

    def run(
        self,
        *,
        progress: Optional[ProgressFunction] = None,
        timeout: Optional[float] = None,
        threads: int = 0,
    ) -> str:
        """The whole automatic segmentation; returns why it ended: "converged", "regions", "deadline" … Undoable."""
        _check_progress(progress)
        return self._native.run(progress, timeout, threads)

    def set_labels(self, labels: Any) -> None:
        """Replaces the partition by (F,) integers; disconnected regions are split. Undoable."""
        self._native.set_labels(_arrays.labels_of(labels, self._faces))

    def insert(self, face: Optional[int] = None) -> int:
        """New region seeded at ``face``, None: where the partition is worst. Returns its label. Undoable."""
        return self._native.insert(face)

    def merge(self, a: int, b: int) -> None:
        """Merges two regions that touch. Undoable."""
        self._native.merge(a, b)

    def merge_candidate(self, a: int, b: int) -> Tuple[float, bool]:
        """The energy that merging would add, and whether the common fit is valid. Changes nothing."""
        return self._native.merge_candidate(a, b)

    def relax(
        self,
        iterations: int = 1,
        *,
        progress: Optional[ProgressFunction] = None,
        timeout: Optional[float] = None,
        threads: int = 0,
    ) -> float:
        """Up to so many Lloyd iterations; returns the energy. Undoable."""
        _check_progress(progress)
        return self._native.relax(iterations, progress, timeout, threads)

    def smooth(self) -> None:
        """Smooths the borders of regions by graph cuts. Undoable."""
        self._native.smooth()

    def undo(self) -> bool:
        """Takes the last undoable operation back; False when there is none."""
        return self._native.undo()

    def result(self, *, threads: int = 0) -> Segmentation:
        """The current partition as :func:`segment` returns one."""
        return _segmentation(self._native.result(threads))
