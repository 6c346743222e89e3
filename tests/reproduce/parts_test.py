"""The parts of tools/reproduce on exact small cases."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/reproduce"))

import copies  # noqa: E402
import document  # noqa: E402
import implicit  # noqa: E402
import limit_figures  # noqa: E402
import mesh_files  # noqa: E402
import png  # noqa: E402
import process_figures  # noqa: E402


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name) / "a.png"

    def tearDown(self):
        self.folder.cleanup()

    def test_what_is_written_is_read(self):
        image = np.random.default_rng(1).integers(0, 256, (37, 23, 3), dtype=np.uint8)
        png.write(self.path, image)
        self.assertTrue((png.read(self.path) == image).all())

    def test_halving_averages_and_joining_pads(self):
        image = np.zeros((4, 6, 3), np.uint8)
        image[:2, :2] = [[[0] * 3, [40] * 3], [[80] * 3, [120] * 3]]
        half = png.halved(image)
        self.assertEqual(half.shape, (2, 3, 3))
        self.assertEqual(half[0, 0].tolist(), [60] * 3)
        joined = png.side_by_side([half, np.zeros((5, 2, 3), np.uint8)])
        self.assertEqual(joined.shape, (5, 5, 3))
        self.assertEqual(joined[4, 0].tolist(), [255] * 3)

    def test_posterised_keeps_white_and_is_near(self):
        image = np.arange(256, dtype=np.uint8).repeat(3).reshape(16, 16, 3)
        result = png.posterised(image, 32)
        self.assertEqual(result[15, 15].tolist(), [255] * 3)
        self.assertLessEqual(np.abs(result.astype(int) - image).max(), 8)

    def test_trimming_leaves_a_margin(self):
        image = np.full((100, 80, 3), 255, np.uint8)
        image[40:50, 30:60] = 0
        self.assertEqual(copies.trimmed(image, 8).shape, (26, 46, 3))

    def test_montages_are_small_or_refused(self):
        smooth = np.zeros((300, 400, 3), np.uint8)
        smooth[..., 0] = np.arange(400) // 2
        result = self.path.with_name("montage.png")
        png.write(self.path, smooth)
        copies.montage([self.path, self.path], result)
        self.assertLess(result.stat().st_size, copies.LARGEST)
        self.assertEqual(png.read(result).shape, (162, 424, 3))  # halves with a frame of six pixels
        png.write(self.path, np.random.default_rng(1).integers(0, 240, (900, 900, 3), dtype=np.uint8))
        with self.assertRaises(ValueError):
            copies.montage([self.path], result)


class Reports(unittest.TestCase):
    def test_pictures_and_skipped_parts(self):
        section = document.Section("one", "Section one")
        section.figure().add("pictures/a.png", "a picture")
        section.skipped("crank.off", "not there")
        section.table(["x", "y"]).add("1", "2")
        report = document.Document("Title", ["Words."])
        report.sections.append(section)
        self.assertIn("pictures/a.png", report.markdown())
        self.assertNotIn("pictures/a.png", report.markdown(pictures=False))
        for text in (report.markdown(pictures=False), report.html()):
            self.assertIn("crank.off: not there", text)
        self.assertIn("| 1 | 2 |", report.markdown())
        data = report.data()["sections"][0]
        self.assertEqual(data["pictures"], [{"file": "pictures/a.png", "text": "a picture"}])
        self.assertEqual(data["skipped"], ["crank.off: not there"])


class Meshes(unittest.TestCase):
    def test_off_keeps_every_bit(self):
        positions, triangles = implicit.saddle(3)
        positions = positions / 3
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.off"
            mesh_files.write_off(path, positions, triangles)
            read = mesh_files.read(path)
        self.assertTrue((read[0] == positions).all())
        self.assertTrue((read[1] == triangles).all())

    def test_joined_meshes_keep_their_triangles(self):
        mesh = implicit.saddle(2)
        positions, triangles, source = mesh_files.joined([mesh, mesh])
        self.assertTrue((mesh_files.centroids(positions, triangles)[source == 1] == mesh_files.centroids(*mesh)).all())

    def test_shapes_lie_on_their_quadrics(self):
        quadrics = {"elliptic cylinder": [-1, 0, 0, 0, 1, 0, 0, 1 / 0.35**2, 0, 0],
                    "ellipsoid": [-1, 0, 0, 0, 1, 0, 0, 1 / 0.6**2, 0, 1 / 0.35**2],
                    "saddle": [0, 0, 0, -1, 1, 0, 0, -1, 0, 0]}
        self.assertEqual(set(quadrics), set(implicit.SHAPES))
        for name, make in implicit.SHAPES.items():
            positions, triangles = make(6)
            self.assertLess(np.abs(implicit.values(quadrics[name], positions)).max(), 1e-14, name)
            self.assertEqual(set(triangles.ravel()), set(range(len(positions))), name)

    def test_the_zero_set_of_a_sphere_has_its_area(self):
        corners, triangles = implicit.zero_set([-1, 0, 0, 0, 1, 0, 0, 1, 0, 1], [-1.2] * 3, [1.2] * 3, 40)
        self.assertLess(np.abs(np.linalg.norm(corners, axis=1) - 1).max(), 2e-3)
        self.assertAlmostEqual(mesh_files.areas(corners, triangles).sum() / (4 * np.pi), 1, delta=5e-3)

    def test_no_zero_set_is_no_triangle(self):
        self.assertEqual(len(implicit.zero_set([1] + [0] * 9, [0] * 3, [1] * 3, 4)[1]), 0)

    def test_labels_of_the_nearest_face(self):
        mesh = implicit.saddle(4)
        labels = np.arange(len(mesh[1]))
        self.assertTrue((process_figures.nearest_labels(mesh, mesh, labels) == labels).all())


class Overlaps(unittest.TestCase):
    def test_iou_of_a_split_and_a_whole_surface(self):
        truth, labels = np.array([0, 0, 0, 0, 1, 1]), np.array([0, 0, 0, 1, 2, 2])
        shared = limit_figures.overlap(truth, labels, np.ones(6))
        self.assertAlmostEqual(limit_figures.mean_best_iou(shared), (0.75 + 1) / 2)

    def test_a_region_shared_by_two_surfaces_is_nobodys_own(self):
        truth, labels = np.array([0, 0, 1, 1, 2, 2]), np.array([0, 0, 0, 0, 1, 1])
        shared = limit_figures.overlap(truth, labels, np.ones(6))
        self.assertEqual(limit_figures.own_regions(shared, np.array([0, 1, 2])), 1)


class Numbers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        (pathlib.Path(self.folder.name) / "r.json").write_text('{"a": {"b": [2, 0.25]}, "none": 0}')

    def tearDown(self):
        self.folder.cleanup()

    def number(self, path, pattern="%.3g"):
        return document.Number(self.folder.name, "r.json", path, pattern)

    def test_they_are_looked_up(self):
        self.assertEqual(self.number("a/b/1").text, "0.25")
        self.assertEqual(self.number("a/b", "%d").text, "2")  # the length of a list
        with self.assertRaises(KeyError):
            self.number("a/c")

    def test_ratios_and_what_is_left_of_nothing(self):
        self.assertEqual(document.Ratio(self.number("a/b/0"), self.number("a/b/1")).text, "8")
        self.assertEqual(document.Ratio(self.number("a/b/0"), self.number("none")).text, "> 10⁶")

    def test_a_row_has_as_many_cells_as_columns(self):
        with self.assertRaises(ValueError):
            document.Table(["one", "two"]).add("1")

    def test_html_escapes_and_marks_up(self):
        self.assertEqual(document.marked_up("a < **b** `c`"), "a &lt; <b>b</b> <code>c</code>")


if __name__ == "__main__":
    unittest.main()
