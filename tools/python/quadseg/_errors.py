"""What can go wrong, by kind. Every exception of the package is an Error."""

from __future__ import annotations


class Error(Exception):
    """Anything that goes wrong in quadseg. ``code`` names it: "invalid_mesh", "file_format" …"""

    code: str = "internal"


class OptionError(Error, ValueError):
    """An option out of range or arrays of the wrong shape or type; the text names it."""


class InputError(Error, ValueError):
    """The arrays are no mesh: an index out of range, a coordinate that is not finite, no face with an area."""


class FileError(Error, OSError):
    """A file that can't be opened, read or written; ``code`` is file_open, file_format or file_write."""


class Cancelled(Error):
    """Stopped before there was anything to return."""


class OutOfMemory(Error, MemoryError):
    """The job would need more than ``memory_limit``, or an allocation failed."""


class InternalError(Error, RuntimeError):
    """A defect of quadseg."""


_KINDS: dict[str, type[Error]] = {
    "invalid_argument": OptionError,
    "invalid_mesh": InputError,
    "empty_mesh": InputError,
    "file_open": FileError,
    "file_format": FileError,
    "file_write": FileError,
    "cancelled": Cancelled,
    "memory_limit": OutOfMemory,
    "out_of_memory": OutOfMemory,
}


def make(code: str, text: str) -> Error:
    """The exception for an error of the library."""
    error = _KINDS.get(code, InternalError)(text)
    error.code = code
    return error
