"""segment() on NumPy arrays: results, copies, limits, errors."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import quadseg


def test_finds_the_three_surfaces_of_a_can(can):
    vertices, faces = can
    result = quadseg.segment(vertices, faces)
    assert result.labels.shape == (len(faces),) and result.labels.dtype == np.int32
    assert sorted(region.type for region in result.regions) == ["cylinder", "plane", "plane"]
    assert not result.partial and result.stop in ("converged", "regions", "tolerance", "maximum")
    for region in result.regions:
        mine = result.labels == region.id
        assert region.faces == mine.sum() > 0
        x, y, z = vertices[faces[mine]].reshape(-1, 3).T
        monomials = np.stack([np.ones_like(x), x, y, z, x * x, x * y, x * z, y * y, y * z, z * z])
        assert np.abs(region.coefficients @ monomials).max() < 1e-6
    (side,) = (region for region in result.regions if region.type == "cylinder")
    assert side.parameters["radius"] == pytest.approx(1, abs=1e-9)
    assert abs(side.parameters["axis"] @ [0, 0, 1]) == pytest.approx(1, abs=1e-9)
    assert side.outward
    assert result.energy.total == pytest.approx(result.energy.distance + 0.5 * result.energy.normal)
    assert result.seconds.total > 0 and result.peak_bytes > 0 and result.threads >= 1
    assert result.report.faces == len(faces) and result.report.components == 1
    assert "3 regions" in repr(result)


def test_labels_are_those_of_the_program(can, tmp_path):
    program = os.environ.get("QUADSEG_PROGRAM")
    if not program:
        pytest.skip("QUADSEG_PROGRAM is not set")
    quadseg.write(tmp_path / "can.ply", *can)
    subprocess.run([program, "segment", tmp_path / "can.ply", "-o", tmp_path / "out", "--quiet"], check=True)
    mesh = quadseg.read(tmp_path / "can.ply")
    labels = quadseg.segment(mesh.vertices, mesh.faces).labels
    assert np.array_equal(labels, np.loadtxt(tmp_path / "out" / "labels.txt", dtype=int))


def test_arrays_in_the_right_form_are_not_copied(can):
    from quadseg import _arrays

    vertices, faces = can
    assert _arrays.vertices_of(vertices) is vertices
    assert _arrays.faces_of(faces) is faces
    frozen = vertices.copy()
    frozen.flags.writeable = False
    assert _arrays.vertices_of(frozen) is frozen
    assert quadseg.segment(frozen, faces).labels.shape == (len(faces),)


def test_results_own_their_buffers(can):
    result = quadseg.segment(*can, project=True)
    # The base is a capsule around the C++ vector: nothing was copied into memory of NumPy.
    for array in (result.labels, result.table, result.projected):
        assert not array.flags.owndata and type(array.base).__name__ == "PyCapsule"
    labels, expected = result.labels, result.labels.copy()
    del result
    quadseg.segment(*can)
    assert np.array_equal(labels, expected)


@pytest.mark.parametrize("kind", ["float32", "int64 faces", "int32 faces", "lists", "fortran", "strided", "big endian"])
def test_other_arrays_are_converted(can, kind):
    vertices, faces = can
    expected = quadseg.segment(vertices.astype(np.float32) if kind == "float32" else vertices, faces).labels
    given = {
        "float32": (vertices.astype(np.float32), faces),
        "int64 faces": (vertices, faces.astype(np.int64)),
        "int32 faces": (vertices, faces.astype(np.int32)),
        "lists": (vertices.tolist(), faces.tolist()),
        "fortran": (np.asfortranarray(vertices), np.asfortranarray(faces)),
        "strided": (np.repeat(vertices, 2, axis=0)[::2], np.repeat(faces, 2, axis=1)[:, ::2]),
        "big endian": (vertices.astype(">f8"), faces.astype(">u4")),
    }[kind]
    assert np.array_equal(quadseg.segment(*given).labels, expected)


@pytest.mark.parametrize(
    "vertices, faces, error, text",
    [
        (np.zeros((4, 2)), np.zeros((1, 3), int), quadseg.OptionError, "vertices"),
        (np.zeros((4, 3)), np.zeros((1, 4), int), quadseg.OptionError, "faces"),
        (np.zeros((4, 3)), np.zeros((1, 3)), quadseg.OptionError, "integers"),
        (np.eye(3), [[0, 1, 3]], quadseg.InputError, "3"),
        (np.eye(3), [[0, 1, -1]], quadseg.InputError, "-1"),
        (np.eye(3), [[0, 1, 2**32 + 2]], quadseg.InputError, str(2**32 + 2)),
        (np.eye(3) * np.nan, [[0, 1, 2]], quadseg.InputError, "vertex"),
        (np.zeros((0, 3)), np.zeros((0, 3), int), quadseg.InputError, "no face"),
        ([], [], quadseg.InputError, "no face"),
        ([["a", "b", "c"]], [[0, 0, 0]], quadseg.OptionError, "numbers"),
    ],
)
def test_bad_arrays_are_refused(vertices, faces, error, text):
    with pytest.raises(error, match=text) as caught:
        quadseg.segment(vertices, faces)
    assert isinstance(caught.value, quadseg.Error) and isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    "options",
    [
        {"preset": "fast"},
        {"detail": -1},
        {"regions": -3},
        {"regions": "many"},
        {"feature_angle": 500},
        {"paper": {"no_such": 1}},
        {"paper": {"lloyd_iterations": 0}},
        {"timeout": -1},
        {"threads": -1},
        {"progress": 5},
    ],
)
def test_bad_options_are_named(can, options):
    with pytest.raises(quadseg.OptionError) as caught:
        quadseg.segment(*can, **options)
    name = next(iter(options))
    words = {"timeout": "time limit", "feature_angle": "feature", "paper": list(options.get("paper", {"": 0}))[0]}
    assert words.get(name, name) in str(caught.value)
    assert caught.value.code == "invalid_argument"


def test_options_reach_the_library(can):
    vertices, faces = can
    paper = quadseg.segment(vertices, faces, preset="paper", regions=4, paper={"lloyd_iterations": 3}, seed=7)
    assert len(paper.regions) == 4 and len(paper.energies) > 0
    projected = quadseg.segment(vertices, faces, project=True).projected
    assert projected.shape == vertices.shape and np.allclose(projected, vertices, atol=1e-6)
    assert quadseg.segment(vertices, faces).projected is None


def test_polygons_share_a_label(can):
    vertices, faces = can
    polygons = np.arange(len(faces)) // 2
    labels = quadseg.segment(vertices, faces, polygons=polygons).labels
    assert np.array_equal(labels[0::2], labels[1::2])
    with pytest.raises(quadseg.OptionError, match="polygons"):
        quadseg.segment(vertices, faces, polygons=polygons[:-1])


def test_progress_comes_in_the_callers_thread(large):
    seen, threads = [], set()

    def progress(event):
        seen.append(event)
        threads.add(threading.get_ident())

    quadseg.segment(*large, progress=progress)
    assert threads == {threading.get_ident()}
    fractions = [event.fraction for event in seen]
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] == pytest.approx(1)
    assert {event.phase for event in seen} <= {"prepare", "coarse", "fine", "post"}


def test_a_bar_fits(large):
    tqdm = pytest.importorskip("tqdm")
    with tqdm.tqdm(total=1.0, file=open(os.devnull, "w")) as bar:
        quadseg.segment(*large, progress=lambda event: bar.update(event.fraction - bar.n))
        assert bar.n == pytest.approx(1)


def test_false_stops_with_a_partial_result(large):
    result = quadseg.segment(*large, progress=lambda event: False)
    assert result.partial and result.stop == "cancelled"
    assert len(result.labels) == len(large[1])


def test_what_the_callback_raises_is_raised(large):
    def progress(event):
        raise RuntimeError("from the callback")

    with pytest.raises(RuntimeError, match="from the callback"):
        quadseg.segment(*large, progress=progress)


def test_timeout_gives_a_partial_result(large):
    start = time.monotonic()
    result = quadseg.segment(*large, timeout=0.01)
    assert result.partial and result.stop == "deadline"
    assert time.monotonic() - start < 5


def test_memory_limit(large):
    with pytest.raises(quadseg.OutOfMemory) as caught:
        quadseg.segment(*large, memory_limit=1 << 20)
    assert isinstance(caught.value, MemoryError) and caught.value.code == "memory_limit"


def test_keyboard_interrupt_stops_a_call(large):
    # In a process of its own: pytest has its own handler, and the signal must come in the middle.
    code = f"""
import os, signal, sys, threading, time
sys.path.insert(0, {os.path.dirname(__file__)!r})
import numpy as np, quadseg
n = 1200
x, y = np.meshgrid(np.linspace(0, 10, n), np.linspace(0, 10, n))
vertices = np.stack([x, y, np.sin(x) * np.cos(y)], axis=-1).reshape(-1, 3)
i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
sent = []
def interrupt():
    time.sleep(0.3)
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    quadseg.segment(vertices, faces)
    print("finished")
except KeyboardInterrupt:
    print("interrupted after", time.monotonic() - sent[0])
"""
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert output.stdout.startswith("interrupted after"), output
    assert float(output.stdout.split()[-1]) < 2  # 50 ms on a machine of one's own


def test_the_gil_is_released(large):
    """Two at once: while one call works, another thread runs Python and a second call; both are under way together."""
    under_way = [threading.Event(), threading.Event()]
    met = []

    def work(mine):
        def progress(event):
            under_way[mine].set()
            if not met:
                # Only if the other call runs at the same time does it ever set its flag.
                met.append(under_way[1 - mine].wait(30))

        quadseg.segment(*large, threads=1, progress=progress)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert met == [True] or all(met)


def test_same_result_at_any_number_of_threads(large):
    one, two = (quadseg.segment(*large, threads=n) for n in (1, 2))
    assert np.array_equal(one.labels, two.labels)
    assert one.table.tobytes() == two.table.tobytes()


def test_memory_does_not_grow(can):
    import resource

    for _ in range(20):
        quadseg.segment(*can)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(100):
        quadseg.segment(*can)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert grown < 8 * 1024, f"{grown} KiB more after 100 runs"


def test_nothing_is_printed(can, capfd):
    quadseg.segment(*can, preset="paper", regions=3)
    quadseg.segment(*can, smooth=True, project=True)
    assert capfd.readouterr() == ("", "")
