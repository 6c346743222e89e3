"""One prepared mesh, many runs and steps."""

import threading

import numpy as np
import pytest

import quadseg


@pytest.fixture
def box():
    """A cube of 12 triangles a face pair … six planes of 2 x 4 x 4 triangles."""
    n = 4
    vertices, faces = [], []
    for axis in range(3):
        for side in (0.0, 1.0):
            start = len(vertices)
            for i in range(n + 1):
                for j in range(n + 1):
                    p = [0.0, 0.0, 0.0]
                    p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, i / n, j / n
                    vertices.append(p)
            for i in range(n):
                for j in range(n):
                    a, b = start + i * (n + 1) + j, start + (i + 1) * (n + 1) + j
                    quad = [(a, b, b + 1), (a, b + 1, a + 1)]
                    faces += quad if side else [face[::-1] for face in quad]
    return np.array(vertices), np.array(faces, dtype=np.uint32)


def test_runs_again_under_other_options(box):
    s = quadseg.Segmenter(*box, preset="paper")
    assert s.regions == 1
    for regions in (3, 6):
        s.set_options(preset="paper", regions=regions)
        assert s.run(threads=1) == "regions"
        assert s.regions == regions
        whole = quadseg.segment(*box, preset="paper", regions=regions)
        np.testing.assert_array_equal(s.labels, whole.labels)
    s.set_options()
    s.run()
    result = s.result()
    assert isinstance(result, quadseg.Segmentation)
    assert [region.type for region in result.regions] == ["plane"] * 6
    np.testing.assert_array_equal(result.labels, quadseg.segment(*box).labels)


def test_steps_and_undo(box):
    s = quadseg.Segmenter(*box, preset="paper")
    before = s.labels
    assert s.insert() == 1
    assert s.insert(7) == 2
    energy = s.relax(3)
    assert energy >= 0
    increase, valid = s.merge_candidate(0, 1)
    assert np.isfinite(increase) and isinstance(valid, bool)
    s.merge(0, 1)
    s.smooth()
    assert s.regions == 2
    while s.undo():
        pass
    np.testing.assert_array_equal(s.labels, before)
    s.set_labels(np.arange(len(before)) // 32)
    assert s.regions == 6
    labels = s.labels
    labels[:] = -5
    assert s.regions == 6 and s.labels.min() == 0, "labels are a copy"


def test_mistakes_change_nothing(box):
    with pytest.raises(quadseg.OptionError):
        quadseg.Segmenter(*box, no_such_option=1)
    with pytest.raises(quadseg.InputError):
        quadseg.Segmenter(box[0], box[1] + 1000)
    s = quadseg.Segmenter(*box)
    for call in (
        lambda: s.insert(10**6),
        lambda: s.merge(0, 9),
        lambda: s.set_labels([1, 2, 3]),
        lambda: s.set_options(detail=-1),
        lambda: s.run(progress=3),
    ):
        with pytest.raises(quadseg.OptionError):
            call()
    assert s.regions == 1


def test_stopped_and_used_again(box):
    s = quadseg.Segmenter(*box, preset="paper", regions=6)

    def no(_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        for _ in range(1000):
            s.run(progress=no)
    s.run()
    assert s.regions == 6


def test_another_thread_is_turned_away(box):
    s = quadseg.Segmenter(*box, preset="paper", regions=6)
    outcomes = []

    def use(progress):
        if not outcomes:
            other = threading.Thread(target=lambda: outcomes.append(pytest.raises(quadseg.OptionError, lambda: s.labels)))
            other.start()
            other.join()

    s.run(progress=use)
    assert len(outcomes) == 1
    assert s.regions == 6
