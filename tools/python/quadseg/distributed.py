"""The same batch as ``quadseg batch``, on a Dask cluster: manifest in, results log out.

>>> from distributed import Client                                            # doctest: +SKIP
>>> from quadseg.distributed import run                                       # doctest: +SKIP
>>> run("meshes.txt", "results", Client("scheduler:8786"), resume=True)       # doctest: +SKIP

Every mesh is one task, done by the program ``quadseg`` in a process of its own, exactly as ``quadseg batch`` does it:
the same files, the same records, the same bounds. The folder of meshes and the output folder must be reachable under
the same paths from every worker and from here; the program must be installed on each. What Dask adds is the machines:
a task whose worker is lost is done again elsewhere. Results of ``quadseg batch`` and of this module can be resumed by
one another.

Or from a shell: ``python -m quadseg.distributed MANIFEST OUTPUT --scheduler ADDRESS [options of quadseg batch]``.
"""

from __future__ import annotations

import argparse
import fcntl
import glob
import json
import os
import shutil
import subprocess
import sys
from typing import Any, Callable, Iterable, Mapping, Optional, Sequence

from ._errors import make

Record = dict[str, Any]
_EXIT_CODES = {2: "invalid_argument", 3: "file_open"}


def _run_program(words: Sequence[str]) -> str:
    """What the program prints; what it complains about as an exception."""
    try:
        done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    except OSError as error:
        raise make("file_open", f"{words[0]}: can't be started: {error.strerror}") from error
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if line] or [f"ended with {done.returncode}"]
        raise make(_EXIT_CODES.get(done.returncode, "internal"), lines[-1].removeprefix("quadseg: "))
    return done.stdout


def _mesh_task(program: str, item: Mapping[str, Any], output: str, options: Sequence[str]) -> Record:
    """On a worker. A failure of the mesh is a record; only a failure of the worker or the program is an exception."""
    words = [program, "batch-item", item["mesh"], "--name", item["name"], "-o", output, *options]
    return json.loads(_run_program(words))


def _remove_scratch(output: str) -> None:
    """What lost workers left unfinished. Only with the log locked: then no other run has any."""
    for folder in glob.glob(os.path.join(glob.escape(output), ".unfinished-*")):
        shutil.rmtree(folder, ignore_errors=True)


class _Log:
    """The results log, locked as ``quadseg batch`` does, each record on disk before it counts."""

    def __init__(self, output: str) -> None:
        path = os.path.join(output, "results.jsonl")
        self._file = open(path, "ab", buffering=0)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self._file.close()
            raise make("invalid_argument", f"{path}: another batch is at work on this log") from None

    def append(self, record: Record) -> None:
        line = json.dumps(record, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "replace") + b"\n"
        before = os.fstat(self._file.fileno()).st_size
        try:
            if self._file.write(line) != len(line):
                raise OSError("the disk is full")
            os.fsync(self._file.fileno())
        except OSError as error:
            os.ftruncate(self._file.fileno(), before)
            raise make("file_write", f"{self._file.name}: {error}") from error

    def close(self) -> None:
        self._file.close()


def run(
    meshes: str,
    output: str,
    client: Any,
    *,
    options: Iterable[str] = (),
    resume: bool = False,
    retry: bool = False,
    retries: int = 3,
    program: str = "quadseg",
    progress: Optional[Callable[[int, int, Record], Any]] = None,
) -> list[Record]:
    """Segments all meshes of a folder or manifest on a Dask cluster.

    Parameters
    ----------
    meshes : str
        Folder or manifest, as for ``quadseg batch``.
    output : str
        Folder for ``results.jsonl`` and a folder for each mesh, on a file system that all workers share.
    client : distributed.Client
    options : strings
        Options of ``quadseg batch`` for each mesh: ``["--timeout", "60", "--memory-limit", "2G", "--smooth"]``.
    resume, retry : bool
        Go on with what is not in the log yet; ``retry``: do again what is not complete, too.
    retries : int
        How often a task may fail for reasons other than the mesh (no disk, no program). Lost workers don't count here;
        the scheduler's own ``allowed-failures`` bounds how many workers one mesh may take down.
    program : str
        The program, under this name or path on every worker and here.
    progress : callable, optional
        Called with (done, total, record) after each mesh.

    Returns the records of the meshes that were done now. A mesh that fails is a record with ``status`` "failed"; a
    mesh that no worker could do (KilledWorker, no program) is one of ``kind`` "lost", and is not in the log: it will be
    done by the next ``resume``. Raises Error for a manifest or options that make no sense, FileError for a log that
    can't be written.
    """
    from distributed import as_completed

    options = [str(option) for option in options]
    mode = ["--retry"] if retry else ["--resume"] if resume else []
    listing = _run_program([program, "batch", meshes, "-o", output, "--list", *mode, *options])
    items = [json.loads(line) for line in listing.splitlines()]
    output = os.path.abspath(output)
    for item in items:
        item["mesh"] = os.path.abspath(item["mesh"])
    log = _Log(output)
    _remove_scratch(output)
    records: list[Record] = []
    futures = {}
    try:
        for item in items:
            # pure=False: the name of a task must not depend on its arguments, or a retry would find the old failure.
            future = client.submit(_mesh_task, program, item, output, options, retries=retries, pure=False)
            futures[future] = item
        for future in as_completed(futures):
            item = futures[future]
            if future.status == "finished":
                record = future.result()
                log.append(record)
            else:
                reason = future.exception() if future.status == "error" else future.status
                record = {"mesh": item["mesh"], "name": item["name"], "status": "failed", "kind": "lost"}
                record["message"] = f"{type(reason).__name__}: {reason}"
            records.append(record)
            if progress is not None:
                progress(len(records), len(items), record)
            future.release()
    finally:
        for future in futures:
            if not future.done():
                future.cancel()
        _remove_scratch(output)
        log.close()
    return records


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """python -m quadseg.distributed"""
    parser = argparse.ArgumentParser(
        prog="python -m quadseg.distributed",
        description="quadseg batch on a Dask cluster; further options are those of quadseg batch",
    )
    parser.add_argument("meshes", help="folder or manifest")
    parser.add_argument("output", help="folder that all workers share")
    parser.add_argument("--scheduler", required=True, help="address of the Dask scheduler")
    parser.add_argument("--program", default="quadseg", help="the program, on every worker")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--retry", action="store_true")
    known, options = parser.parse_known_args(arguments)
    from distributed import Client

    def show(done: int, total: int, record: Record) -> None:
        print(f"{done}/{total} {record['name']}: {record['status']}", file=sys.stderr, flush=True)

    with Client(known.scheduler) as client:
        records = run(
            known.meshes,
            known.output,
            client,
            options=options,
            resume=known.resume,
            retry=known.retry,
            program=known.program,
            progress=show,
        )
    failed = [record for record in records if record["status"] == "failed"]
    for record in failed:
        print(f"{record['name']}: {record.get('kind')}: {record.get('message', '')}", file=sys.stderr)
    print(f"{len(records)} meshes done now, {len(failed)} failed")
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
