"""The compiled part. Use the package quadseg, not this."""

from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import NDArray

version: str
surface_types: tuple[str, ...]

def segment(
    vertices: NDArray[np.float64],
    faces: NDArray[np.uint32],
    polygons: Optional[NDArray[np.uint32]],
    options: dict[str, Any],
    progress: Optional[Callable[..., Any]],
    timeout: Optional[float],
    threads: int,
    memory_limit: int,
) -> dict[str, Any]: ...
def inspect(
    vertices: NDArray[np.float64],
    faces: NDArray[np.uint32],
    feature_degrees: float,
    timeout: Optional[float],
    threads: int,
) -> dict[str, Any]: ...
def read(
    path: bytes, progress: Optional[Callable[..., Any]], timeout: Optional[float], memory_limit: int
) -> dict[str, Any]: ...
def write(
    path: bytes,
    vertices: NDArray[np.float64],
    faces: NDArray[np.uint32],
    labels: Optional[NDArray[np.int32]],
    colors: Optional[NDArray[np.uint8]],
) -> None: ...
def write_labels(path: bytes, labels: Optional[NDArray[np.int32]], polygons: Optional[NDArray[np.uint32]]) -> None: ...
