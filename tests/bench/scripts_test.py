"""The decisions of bench/compare_revisions and bench/instruction_gate."""
import importlib.machinery
import importlib.util
import json
import pathlib
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"


def load(name):
    loader = importlib.machinery.SourceFileLoader(name, str(BENCH / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


class CompareRevisions(unittest.TestCase):
    def setUp(self):
        self.verdict = load("compare_revisions").verdict

    def flagged(self, first, head, second):
        return self.verdict(first, head, second, relative=0.05, absolute=0.005)[3]

    def test_clearly_slower_is_flagged(self):
        self.assertTrue(self.flagged([1.0, 1.01, 0.99], [1.2, 1.21, 1.19], [1.0, 1.0, 1.01]))

    def test_faster_is_not(self):
        self.assertFalse(self.flagged([1.0, 1.01, 0.99], [0.8, 0.81, 0.79], [1.0, 1.0, 1.01]))

    def test_less_than_the_relative_threshold_is_not(self):
        self.assertFalse(self.flagged([1.0] * 3, [1.04] * 3, [1.0] * 3))

    def test_less_than_the_absolute_threshold_is_not(self):
        self.assertFalse(self.flagged([0.010] * 3, [0.014] * 3, [0.010] * 3))

    def test_less_than_the_noise_of_base_against_base_is_not(self):
        self.assertFalse(self.flagged([1.0, 1.0, 1.0], [1.2, 1.2, 1.2], [1.4, 1.4, 1.4]))

    def test_an_outlier_of_head_is_not(self):
        self.assertFalse(self.flagged([1.0] * 3, [1.0, 1.0, 9.0], [1.0] * 3))

    def test_scatter_within_the_series_counts_as_noise(self):
        scattered = [0.8, 1.0, 1.2, 0.8, 1.2]
        self.assertFalse(self.flagged(scattered, [1.1] * 5, scattered))


class InstructionGate(unittest.TestCase):
    def setUp(self):
        self.compare = load("instruction_gate").compare

    def test_within_the_tolerance_is_fine(self):
        self.assertEqual(self.compare({"a": 1000}, {"a": 1019}, 0.02), [])

    def test_more_and_less_are_named(self):
        problems = self.compare({"a": 1000, "b": 1000}, {"a": 1021, "b": 979}, 0.02)
        self.assertEqual([p.split(":")[0] for p in problems], ["a", "b"])

    def test_new_and_missing_kernels_are_named(self):
        problems = self.compare({"old": 1}, {"new": 1}, 0.02)
        self.assertEqual([p.split(":")[0] for p in problems], ["new", "old"])

    def test_counts_are_stored(self):
        stored = json.loads((BENCH / "instructions.json").read_text())
        self.assertTrue(stored["compiler"])
        self.assertGreater(min(stored["instructions"].values()), 0)


class ThreadSplit(unittest.TestCase):
    def test_work_of_one_thread_is_seen(self):
        code, seconds = load("thread_split").split(["sh", "-c", "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done; exit 5"])
        self.assertEqual(code, 5)
        self.assertEqual(len(seconds), 1)
        self.assertGreater(seconds[0], 0.01)


if __name__ == "__main__":
    unittest.main()
