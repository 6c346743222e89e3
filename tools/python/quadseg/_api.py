"""The functions of the package."""

from __future__ import annotations

import os
from typing import Any, Callable, Mapping, Optional, Union

from . import _arrays, _native
from ._errors import make
from ._types import Energy, Mesh, MeshReport, Progress, Regularity, Segmentation, Timings

ProgressFunction = Callable[[Progress], Any]
Path = Union[str, "os.PathLike[str]"]


def _check_progress(progress: Optional[ProgressFunction]) -> None:
    if progress is not None and not callable(progress):
        raise make("invalid_argument", "progress: must be callable or None")


def _options(given: Mapping[str, Any]) -> dict[str, Any]:
    """As the compiled part takes them."""
    options = dict(given)
    if options.get("coarse") == "auto":
        options["coarse"] = -1
    options["paper"] = dict(options.get("paper") or {})
    return options


def _segmentation(result: dict[str, Any]) -> Segmentation:
    result["energy"] = Energy(*result["energy"])
    result["seconds"] = Timings(*result["seconds"])
    result["report"] = MeshReport(**result["report"])
    result["regularities"] = [Regularity(*each) for each in result["regularities"]]
    return Segmentation(**result)


def segment(
    vertices: Any,
    faces: Any,
    *,
    polygons: Any = None,
    preset: str = "default",
    regions: int = 0,
    tolerance: float = 0.0,
    detail: float = 1.0,
    feature_angle: float = -1.0,
    coarse: Union[int, str] = 0,
    smooth: bool = False,
    smoothing_band: int = 2,
    smoothing_lambda: float = 1.0,
    project: bool = False,
    project_joint: bool = False,
    regularities: bool = True,
    seed: int = 1,
    weight: float = 0.5,
    method: str = "quadric",
    paper: Optional[Mapping[str, Any]] = None,
    progress: Optional[ProgressFunction] = None,
    timeout: Optional[float] = None,
    threads: int = 0,
    memory_limit: int = 0,
) -> Segmentation:
    """Segments a triangle mesh into quadric surface regions.

    The GIL is released: calls in several threads run at once. Ctrl-C stops a call within 50 ms (KeyboardInterrupt).
    The same input and options give the same result at any number of threads.

    Parameters
    ----------
    vertices : (V, 3) array
        Positions, any unit. float64 in C order is used in place; anything else is copied once.
    faces : (F, 3) array
        Vertex indices, counter-clockwise seen from outside. uint32 in C order is used in place; other integers are
        checked and copied once.
    polygons : (F,) array of integers, optional
        The polygon that each triangle was cut from; triangles of one polygon follow one another and share a label.
    preset : "default" or "paper"
        "default" finds the surfaces and their number by itself; "paper" is the variational loop of the paper.
    regions : int
        Number of regions wanted; 0: found by the method itself.
    tolerance : float
        Largest RMS distance of a region from its surface, relative to the diagonal; 0: from the data.
    detail : float
        Above 1 more small features survive, below 1 fewer.
    feature_angle : float
        Edges sharper than this (degrees, 0 to 180) bound regions; negative: as the preset sees fit.
    coarse : int or "auto"
        Faces of a simplified mesh that is segmented first; 0: none; "auto": where it pays.
    smooth : bool
        Smooth the borders of regions by graph cuts (``smoothing_band`` faces on each side, ``smoothing_lambda``).
    project : bool
        Project the vertices onto the surfaces: ``Segmentation.projected``; ``project_joint``: border vertices onto all
        their surfaces at once.
    regularities : bool
        Find parallel, coaxial, equal … surfaces, and make them exactly so where the data allow.
    seed : int
        Of every random choice.
    weight, method, paper
        Weight of the normal term, proxies, and the parameters of the paper's loop by name (see PaperOptions in
        options.h), for preset "paper".
    progress : callable, optional
        Called in this thread with a :class:`Progress`, at most about 50 times a second. Returning False (not None)
        stops the call; an exception does too, and is raised again here.
    timeout : float, optional
        Seconds; then the best result so far comes back, with ``partial`` set and ``stop == "deadline"``.
    threads : int
        At most so many; 0: all cores.
    memory_limit : int
        Bytes; a job that would need more is refused with :class:`OutOfMemory` before it starts; 0: no limit.

    Raises
    ------
    InputError, OptionError, OutOfMemory
        All of them :class:`Error`.
    """
    vertices = _arrays.vertices_of(vertices)
    faces = _arrays.faces_of(faces)
    _check_progress(progress)
    options = {
        "preset": preset,
        "method": method,
        "regions": regions,
        "tolerance": tolerance,
        "detail": detail,
        "feature_angle": feature_angle,
        "weight": weight,
        "seed": seed,
        "coarse": coarse,
        "smooth": smooth,
        "project": project,
        "project_joint": project_joint,
        "regularities": regularities,
        "smoothing_band": smoothing_band,
        "smoothing_lambda": smoothing_lambda,
        "paper": paper,
    }
    result = _native.segment(
        vertices,
        faces,
        _arrays.polygons_of(polygons, len(faces)),
        _options(options),
        progress,
        timeout,
        threads,
        memory_limit,
    )
    return _segmentation(result)


def inspect(
    vertices: Any,
    faces: Any,
    *,
    feature_angle: float = 30.0,
    timeout: Optional[float] = None,
    threads: int = 0,
) -> MeshReport:
    """Checks a mesh without segmenting it.

    ``vertices`` (V, 3), ``faces`` (F, 3) as for :func:`segment`; edges sharper than ``feature_angle`` degrees count as
    features. Raises InputError, Cancelled (out of time).
    """
    return MeshReport(
        **_native.inspect(_arrays.vertices_of(vertices), _arrays.faces_of(faces), feature_angle, timeout, threads)
    )


def read(
    path: Path,
    *,
    progress: Optional[ProgressFunction] = None,
    timeout: Optional[float] = None,
    memory_limit: int = 0,
) -> Mesh:
    """Reads OFF, OBJ, PLY (ascii, binary) or STL (ascii, binary); faces keep the order of the file.

    Polygons are cut into triangles that follow one another. Raises FileError (the text names line or byte), InputError,
    OutOfMemory, Cancelled (out of time, or by ``progress``).
    """
    _check_progress(progress)
    return Mesh(**_native.read(os.fsencode(path), progress, timeout, memory_limit))


def write(path: Path, vertices: Any, faces: Any, *, labels: Any = None, colors: Any = None) -> None:
    """Writes .ply (binary), .off, .obj or .stl (binary) under a temporary name, then renames.

    ``labels`` (F,) integers and ``colors`` (F, 3) uint8 are for .ply only. Raises FileError.
    """
    name = os.fsdecode(path)
    vertices = _arrays.vertices_of(vertices)
    faces = _arrays.faces_of(faces)
    if (labels is not None or colors is not None) and not name.lower().endswith(".ply"):
        raise make("invalid_argument", "labels and colors: only .ply files have them")
    _native.write(
        os.fsencode(path), vertices, faces, _arrays.labels_of(labels, len(faces)), _arrays.colors_of(colors, len(faces))
    )


def write_labels(path: Path, labels: Any, *, polygons: Any = None) -> None:
    """One integer a line: a line a face, or a line a polygon where ``polygons`` (F,) is given. Raises FileError."""
    import numpy as np

    count = np.asarray(labels).shape[0] if np.asarray(labels).ndim == 1 else -1
    _native.write_labels(os.fsencode(path), _arrays.labels_of(labels, count), _arrays.polygons_of(polygons, count))
