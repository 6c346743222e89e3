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
class Segmenter:
    def __init__(
        self,
        vertices: NDArray[np.float64],
        faces: NDArray[np.uint32],
        polygons: Optional[NDArray[np.uint32]],
        options: dict[str, Any],
        progress: Optional[Callable[..., Any]],
        timeout: Optional[float],
        threads: int,
    ) -> None: ...
    def regions(self) -> int: ...
    def labels(self) -> NDArray[np.int32]: ...
    def set_options(self, options: dict[str, Any], threads: int) -> None: ...
    def run(self, progress: Optional[Callable[..., Any]], timeout: Optional[float], threads: int) -> str: ...
    def set_labels(self, labels: Optional[NDArray[np.int32]]) -> None: ...
    def insert(self, face: Optional[int]) -> int: ...
    def merge(self, a: int, b: int) -> None: ...
    def merge_candidate(self, a: int, b: int) -> tuple[float, bool]: ...
    def relax(
        self, iterations: int, progress: Optional[Callable[..., Any]], timeout: Optional[float], threads: int
    ) -> float: ...
    def smooth(self) -> None: ...
    def undo(self) -> bool: ...
    def result(self, threads: int) -> dict[str, Any]: ...

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
