"""What the package returns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from . import _native

#: Names of surface types; ``Segmentation.table["type"]`` holds indices into this.
SURFACE_TYPES: tuple[str, ...] = _native.surface_types


class Progress(NamedTuple):
    """Where a call is."""

    #: "read", "prepare", "coarse", "fine", "post" or "write"
    phase: str
    #: of the whole call, 0 to 1; never falls
    fraction: float
    #: current number of regions, 0 while there are none
    regions: int
    #: current energy in the unit cube, 0 while unknown
    energy: float


class Energy(NamedTuple):
    """Of the final surfaces, in the unit cube; total = distance + weight · normal."""

    total: float
    distance: float
    normal: float


class Timings(NamedTuple):
    """Seconds, wall clock."""

    prepare: float
    coarse: float
    fine: float
    post: float
    total: float


class Regularity(NamedTuple):
    """Regions that share a direction, an axis, a radius …"""

    #: "parallel", "perpendicular", "coaxial", "coplanar", "concentric" or "equal_radius"
    kind: str
    #: ids of the regions
    regions: tuple[int, ...]
    #: the surfaces were made to follow it
    snapped: bool


class MeshReport(NamedTuple):
    """What the check of a mesh found; counts are of the input."""

    faces: int
    vertices: int
    components: int
    border_edges: int
    non_manifold_edges: int
    non_manifold_vertices: int
    isolated_vertices: int
    degenerate_faces: int
    duplicate_faces: int
    flipped_faces: int
    unorientable_edges: int
    stitched_edges: int
    feature_edges: int
    #: of the bounding box, input unit
    diagonal: float
    #: input unit squared
    area: float
    #: distance of the box centre from the origin, in diagonals
    offset: float
    box_min: tuple[float, float, float]
    box_max: tuple[float, float, float]


@dataclass(frozen=True)
class Mesh:
    """A mesh that was read from a file."""

    #: (V, 3) float64
    vertices: NDArray[np.float64]
    #: (F, 3) uint32: triangles in the order of the file
    faces: NDArray[np.uint32]
    #: (F,) uint32: the polygon that each triangle was cut from; None where the file has triangles only
    polygons: Optional[NDArray[np.uint32]]
    #: faces (polygons) in the file
    file_faces: int
    #: STL: corners that were joined with an earlier one at the same position
    welded_vertices: int


@dataclass(frozen=True, eq=False)
class Region:
    """A region and its surface, in the coordinates and unit of the input."""

    #: its label
    id: int
    #: one of SURFACE_TYPES
    type: str
    #: number of its faces
    faces: int
    #: input unit squared
    area: float
    #: root mean square and maximum of the distances of its vertices to its surface, relative to the diagonal
    rms: float
    max: float
    #: in the unit cube
    energy: float
    #: equal for regions that lie on one surface
    surface_id: int
    #: the foot points lie on one sheet and the normals agree
    valid: bool
    #: the mesh normal points away from axis, centre or spine: a boss, not a hole
    outward: bool
    #: (10,) float64: c · [1, x, y, z, x², xy, xz, y², yz, z²] = 0
    coefficients: NDArray[np.float64]
    #: what the type has: plane {normal, offset}, sphere {center, radius}, cylinder {axis_point, axis, radius},
    #: cone {apex, axis, half_angle (radians)}, torus {center, axis, major_radius, minor_radius}, blend {radius},
    #: others {center, axes (3, 3), semi_axes}; input unit
    parameters: dict[str, Any]


def _parameters(kind: str, row: np.void) -> dict[str, Any]:
    if kind == "plane":
        return {"normal": row["axis"].copy(), "offset": -float(row["axis"] @ row["point"])}
    if kind == "sphere":
        return {"center": row["point"].copy(), "radius": float(row["radius"])}
    if kind == "cylinder":
        return {"axis_point": row["point"].copy(), "axis": row["axis"].copy(), "radius": float(row["radius"])}
    if kind == "cone":
        return {"apex": row["point"].copy(), "axis": row["axis"].copy(), "half_angle": float(row["half_angle"])}
    if kind == "torus":
        return {
            "center": row["point"].copy(),
            "axis": row["axis"].copy(),
            "major_radius": float(row["radius"]),
            "minor_radius": float(row["minor_radius"]),
        }
    if kind == "blend":
        return {"radius": float(row["radius"])}
    return {
        "center": row["point"].copy(),
        "axes": row["axes"].reshape(3, 3).copy(),
        "semi_axes": row["semi_axes"].copy(),
    }


def _region(row: np.void) -> Region:
    kind = SURFACE_TYPES[row["type"]]
    return Region(
        id=int(row["id"]),
        type=kind,
        faces=int(row["faces"]),
        area=float(row["area"]),
        rms=float(row["rms"]),
        max=float(row["max"]),
        energy=float(row["energy"]),
        surface_id=int(row["surface_id"]),
        valid=bool(row["valid"]),
        outward=bool(row["outward"]),
        coefficients=row["coefficients"].copy(),
        parameters=_parameters(kind, row),
    )


@dataclass(frozen=True, eq=False)
class Segmentation:
    """The result of :func:`quadseg.segment`. Arrays own the library's buffers: nothing was copied."""

    #: (F,) int32: the region of each face, in input order; −1 only for faces in ``unlabelled``
    labels: NDArray[np.int32]
    #: faces without a label: degenerate ones without any neighbour
    unlabelled: NDArray[np.uint32]
    #: (K,) structured array: one row a region, all of its numbers; fast for many regions
    table: NDArray[np.void]
    energy: Energy
    #: distances of the vertices to the surfaces over all regions, relative to the diagonal
    rms: float
    max: float
    #: estimated noise of the vertices, relative to the diagonal
    noise: float
    #: "converged", "regions", "tolerance", "maximum", "deadline" or "cancelled"
    stop: str
    #: stopped by ``timeout`` or by the progress callback: the best result until then
    partial: bool
    seconds: Timings
    #: that could take part
    threads: int
    #: peak resident memory of the process at the end of the call
    peak_bytes: int
    #: what the check of the mesh found
    report: MeshReport
    #: (M,): regions left after each merge of the bottom-up flow, and its estimate of the energy then
    merge_regions: NDArray[np.uint32]
    merge_energies: NDArray[np.float64]
    #: preset "paper": the energy after every Lloyd iteration
    energies: NDArray[np.float64]
    regularities: list[Regularity]
    #: (V, 3) float64 with ``project=True``, else None
    projected: Optional[NDArray[np.float64]]

    @cached_property
    def regions(self) -> list[Region]:
        """One a region, made when first asked for; ``regions[i].id == i``."""
        return [_region(row) for row in self.table]

    def __repr__(self) -> str:
        return (
            f"<quadseg.Segmentation: {len(self.labels)} faces in {len(self.table)} regions, "
            f"rms {self.rms:.3g}, {self.stop}{', partial' if self.partial else ''}>"
        )
