"""The caller's arrays as the library wants them: without a copy where that can be, never with a changed value."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._errors import make


def _shape_error(name: str, wanted: str, array: np.ndarray) -> Exception:
    return make("invalid_argument", f"{name}: must have shape {wanted}, but has {array.shape}")


def vertices_of(given: Any) -> np.ndarray:
    """(V, 3) float64, C-contiguous; that is taken as it is, anything else is copied."""
    array = np.asarray(given)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise _shape_error("vertices", "(V, 3)", array)
    if array.dtype.kind not in "fiu":
        raise make("invalid_argument", f"vertices: must be numbers, but are {array.dtype}")
    return np.require(array, dtype=np.float64, requirements=["C", "ALIGNED"])


def _indices(name: str, array: np.ndarray) -> np.ndarray:
    """uint32, C-contiguous; numbers that do not fit are an error, not wrapped around."""
    if array.dtype.kind not in "iu":
        if array.size > 0:
            raise make("invalid_argument", f"{name}: must be integers, but are {array.dtype}")
    elif array.dtype != np.uint32 and array.size > 0:
        low, high = int(array.min()), int(array.max())
        if low < 0 or high > 0xFFFFFFFF:
            outside = low if low < 0 else high
            where = np.argwhere(array == outside)[0]
            raise make("invalid_mesh", f"{name}: face {where[0]}: index {outside} is out of range")
    return np.require(array, dtype=np.uint32, requirements=["C", "ALIGNED"])


def faces_of(given: Any) -> np.ndarray:
    """(F, 3) uint32, C-contiguous; that is taken as it is, other integers are checked and copied."""
    array = np.asarray(given)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise _shape_error("faces", "(F, 3)", array)
    return _indices("faces", array)


def polygons_of(given: Any, faces: int) -> Optional[np.ndarray]:
    """(F,) uint32 or None."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.shape != (faces,):
        raise _shape_error("polygons", f"({faces},)", array)
    return _indices("polygons", array)


def labels_of(given: Any, faces: int) -> Optional[np.ndarray]:
    """(F,) int32 or None."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.shape != (faces,):
        raise _shape_error("labels", f"({faces},)", array)
    if array.dtype.kind not in "iu":
        raise make("invalid_argument", f"labels: must be integers, but are {array.dtype}")
    if array.size > 0 and (int(array.min()) < -(2**31) or int(array.max()) >= 2**31):
        raise make("invalid_argument", "labels: must fit 32 bits")
    return np.require(array, dtype=np.int32, requirements=["C", "ALIGNED"])


def colors_of(given: Any, faces: int) -> Optional[np.ndarray]:
    """(F, 3) uint8 or None."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.shape != (faces, 3):
        raise _shape_error("colors", f"({faces}, 3)", array)
    if array.dtype != np.uint8:
        raise make("invalid_argument", f"colors: must be uint8, but are {array.dtype}")
    return np.require(array, requirements=["C", "ALIGNED"])
