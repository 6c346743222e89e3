"""The decisions of bench/compare_revisions and bench/instruction_gate."""
import contextlib
import importlib.machinery
import importlib.util
import io
import json
import pathlib
import tempfile
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


# Stands for quadseg: generates an empty mesh, and takes so long to segment it.
STAND_IN = """#!/usr/bin/env python3
import pathlib, sys, time
out = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
out.mkdir(parents=True, exist_ok=True)
if sys.argv[1] == "segment":
    end = time.process_time() + SECONDS
    while time.process_time() < end:
        pass
    (out / "result.json").write_text('{"energy": {"total": 1}}')
"""


class CompareBuilds(unittest.TestCase):
    """The whole script, over two build folders."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, seconds in (("fast", 0.02), ("slow", 0.2), ("same", 0.02)):
            program = self.folder / name / "bin" / "quadseg"
            program.parent.mkdir(parents=True)
            program.write_text(STAND_IN.replace("SECONDS", str(seconds)))
            program.chmod(0o755)

    def compare(self, base, head):
        script = load("compare_revisions")
        script.GENERATED = [("job", "plate", 1000, [])]
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            code = script.main([str(base), str(head), "--rounds", "2"])
        return code, output.getvalue()

    def test_the_slower_build_is_flagged(self):
        code, output = self.compare(self.folder / "fast", self.folder / "slow" / "bin" / "quadseg")
        self.assertEqual(code, 1)
        self.assertIn("**slower**", output)

    def test_the_faster_build_is_not(self):
        code, output = self.compare(self.folder / "slow", self.folder / "same")
        self.assertEqual(code, 0, output)
        self.assertNotIn("**slower**", output)

    def test_a_folder_without_the_program_says_how_to_make_it(self):
        (self.folder / "empty").mkdir()
        (self.folder / "empty" / "CMakeCache.txt").write_text("")
        with self.assertRaisesRegex(SystemExit, "quadseg_program"):
            self.compare(self.folder / "empty", self.folder / "fast")


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
