"""A Dask cluster of processes on loopback; one of its workers is killed in the middle."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time

import pytest

import quadseg
from conftest import make_can

distributed = pytest.importorskip("distributed")
PROGRAM = os.environ.get("QUADSEG_PROGRAM")
pytestmark = pytest.mark.skipif(not PROGRAM, reason="QUADSEG_PROGRAM is not set")

from quadseg.distributed import run  # noqa: E402


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """A scheduler and workers, each a process of its own."""

    def __init__(self, folder, workers=2):
        self.folder = folder
        self.address = f"tcp://127.0.0.1:{free_port()}"
        self.environment = dict(os.environ, DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT="20s")
        self.environment["DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL"] = "30s"
        self.environment["PYTHONWARNINGS"] = "ignore"
        port = self.address.rsplit(":", 1)[1]
        self.scheduler = self.start(
            "scheduler", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard"
        )
        self.workers = [self.add_worker(k) for k in range(workers)]

    def start(self, name, module, *words):
        log = open(self.folder / f"{name}.log", "wb")
        return subprocess.Popen(
            [sys.executable, "-m", module, *words], stdout=log, stderr=log, env=self.environment, cwd=self.folder
        )

    def add_worker(self, k):
        return self.start(
            f"worker{k}",
            "distributed.cli.dask_worker",
            self.address,
            "--nthreads", "1", "--no-nanny", "--no-dashboard", "--name", f"w{k}", "--host", "127.0.0.1",
        )  # fmt: skip

    def close(self):
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cluster")
    cluster = Cluster(folder)
    try:
        with distributed.Client(cluster.address, timeout="60s") as client:
            client.wait_for_workers(2, timeout=60)
            cluster.client = client
            yield cluster
    except Exception:
        for log in folder.glob("*.log"):
            print(log.name, log.read_text()[-2000:])
        raise
    finally:
        cluster.close()


@pytest.fixture
def meshes(tmp_path):
    folder = tmp_path / "meshes"
    folder.mkdir()
    for k in range(12):
        quadseg.write(folder / f"can{k:02}.ply", *make_can(24 + 4 * k, 12))
    (folder / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n")
    return folder


def records_of(output):
    return [json.loads(line) for line in (output / "results.jsonl").read_text().splitlines()]


def comparable(output):
    """All files with what may not differ between two runs."""
    files = {}
    for path in sorted(output.rglob("*")):
        name = str(path.relative_to(output))
        if path.name == "result.json":
            result = json.loads(path.read_text())
            for key in ("seconds", "threads", "peak_bytes"):
                del result[key]
            files[name] = result
        elif path.name == "results.jsonl":
            drop = ("seconds", "peak_bytes")
            files[name] = sorted(
                json.dumps({k: v for k, v in record.items() if k not in drop}) for record in records_of(output)
            )
        elif path.is_file():
            files[name] = path.read_bytes()
        else:
            files[name] = "folder"
    return files


def test_the_same_as_a_batch_on_one_machine(cluster, meshes, tmp_path):
    done = subprocess.run([PROGRAM, "batch", meshes, "-o", tmp_path / "one", "--quiet", "--no-write-types"])
    assert done.returncode == 3
    seen = []
    records = run(
        str(meshes),
        str(tmp_path / "cluster"),
        cluster.client,
        program=PROGRAM,
        options=["--no-write-types"],
        progress=lambda done, total, record: seen.append((done, total)),
    )
    assert len(records) == 13 and seen[-1] == (13, 13)
    assert [r["kind"] for r in records if r["status"] == "failed"] == ["input"]
    assert comparable(tmp_path / "cluster") == comparable(tmp_path / "one")
    # Nothing is left to do, for either of them.
    again = run(
        str(meshes), str(tmp_path / "cluster"), cluster.client, program=PROGRAM, options=["--no-write-types"], resume=True
    )
    assert again == []
    with pytest.raises(quadseg.OptionError, match="earlier batch"):
        run(str(meshes), str(tmp_path / "cluster"), cluster.client, program=PROGRAM)


def test_a_lost_worker_loses_nothing(cluster, meshes, tmp_path):
    # Big enough that the worker is killed in the middle of meshes, and that its half-done mesh would show.
    for k in range(6):
        quadseg.write(meshes / f"big{k}.ply", *make_can(200, 60 + k))
    victim = cluster.workers[0]
    killed = []

    def progress(done, total, record):
        if not killed:
            victim.send_signal(signal.SIGKILL)
            killed.append(done)

    records = run(str(meshes), str(tmp_path / "out"), cluster.client, program=PROGRAM, progress=progress)
    assert killed and victim.wait(timeout=10) == -signal.SIGKILL
    assert len(records) == 19
    names = [record["name"] for record in records_of(tmp_path / "out")]
    assert sorted(names) == sorted(path.name for path in meshes.iterdir()), "each mesh once, none lost"
    assert [record["kind"] for record in records if record["status"] != "ok"] == ["input"]
    for path in meshes.glob("*.ply"):
        assert (tmp_path / "out" / path.name / "labels.txt").exists()
    subprocess.run([PROGRAM, "batch", meshes, "-o", tmp_path / "one", "--quiet"])
    assert comparable(tmp_path / "out") == comparable(tmp_path / "one")
    cluster.workers.append(cluster.add_worker(2))
    cluster.client.wait_for_workers(2, timeout=60)


def test_what_makes_no_sense_is_told_at_once(cluster, meshes, tmp_path):
    with pytest.raises(quadseg.OptionError, match="detail"):
        run(str(meshes), str(tmp_path / "out"), cluster.client, program=PROGRAM, options=["--detail", "-1"])
    with pytest.raises(quadseg.FileError, match="manifest"):
        run(str(tmp_path / "none"), str(tmp_path / "out"), cluster.client, program=PROGRAM)
    with pytest.raises(quadseg.FileError, match="no-such-program"):
        run(str(meshes), str(tmp_path / "out"), cluster.client, program="no-such-program")
