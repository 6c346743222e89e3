"""Segments triangle meshes into quadric surface regions: planes, spheres, cylinders, cones, tori, general quadrics.

>>> import quadseg
>>> mesh = quadseg.read("part.stl")                          # doctest: +SKIP
>>> result = quadseg.segment(mesh.vertices, mesh.faces)      # doctest: +SKIP
>>> [(region.type, region.faces) for region in result.regions]  # doctest: +SKIP

After ``os.fork()`` in a process that has used quadseg, don't use it in the child: start workers by "spawn".
"""

from ._api import ProgressFunction, inspect, read, segment, write, write_labels
from ._errors import Cancelled, Error, FileError, InputError, InternalError, OptionError, OutOfMemory
from ._segmenter import Segmenter
from ._native import version as __version__
from ._types import (
    SURFACE_TYPES,
    Energy,
    Mesh,
    MeshReport,
    Progress,
    Region,
    Regularity,
    Segmentation,
    Timings,
)

__all__ = [
    "SURFACE_TYPES",
    "Cancelled",
    "Energy",
    "Error",
    "FileError",
    "InputError",
    "InternalError",
    "Mesh",
    "MeshReport",
    "OptionError",
    "OutOfMemory",
    "Progress",
    "ProgressFunction",
    "Region",
    "Regularity",
    "Segmentation",
    "Segmenter",
    "Timings",
    "__version__",
    "inspect",
    "read",
    "segment",
    "write",
    "write_labels",
]
