"""Whole reports in quick mode: every section, real pictures, numbers that stand in the runs' result files, and what happens
where meshes or programs are missing."""
import html
import html.parser
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["QUADSEG_PROGRAM"]
TABLES = os.environ.get("QUADSEG_TABLES", "")
SECTIONS = ["tables", "figure1", "figure3", "figure5", "figure6", "figure7", "figure8", "figure9", "figure10", "figure11",
            "figure12", "figure14", "figure15", "real"]


def reproduce(out, *arguments, program=PROGRAM):
    tables = ["--tables", TABLES] if pathlib.Path(TABLES).is_file() else []
    return subprocess.run([sys.executable, str(ROOT / "tools/reproduce"), "--program", program, "--quick", "--out", str(out), *tables,
                           *map(str, arguments)], check=False, text=True, capture_output=True)


def report_of(out):
    return json.loads((out / "report.json").read_text())


def section_of(report, identifier):
    return next(s for s in report["sections"] if s["id"] == identifier)


def value_at(out, source):
    value = json.loads((out / source["file"]).read_text())
    for key in source["path"].split("/"):
        value = value[int(key)] if isinstance(value, list) else value[key]
    return len(value) if isinstance(value, (dict, list)) else value


def numbers(report):
    for section in report["sections"]:
        for table in section["tables"]:
            for row in table["rows"]:
                yield from (cell for cell in row if "sources" in cell)


def wrong_numbers(out, report):
    """Cells whose text is not what their result files say."""
    wrong = []
    for cell in numbers(report):
        values = [value_at(out, source) for source in cell["sources"]]
        if len(values) == 2:
            value = values[0] / values[1] if values[1] else float("inf")
        else:
            value = values[0]
        large = value > 1e6 and "d" not in cell["pattern"]
        if cell["text"] != ("> 10⁶" if large else cell["pattern"] % value):
            wrong.append(cell)
    return wrong


def png_rows(path):
    """Width, height and the unpacked rows of a PNG; raises on anything that is none."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    place, packed, width, height = 8, b"", 0, 0
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        if struct.unpack(">I", data[place + 8 + length:place + 12 + length])[0] != zlib.crc32(kind + body):
            raise ValueError("damaged")
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        packed += body if kind == b"IDAT" else b""
        place += 12 + length
    return width, height, zlib.decompress(packed)


class Page(html.parser.HTMLParser):
    """Open tags, links to pictures and to sections of a page."""

    EMPTY = {"meta", "img"}

    def __init__(self, text):
        super().__init__()
        self.open, self.pictures, self.anchors, self.links = [], set(), set(), set()
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.pictures |= {values["src"]} if tag == "img" else set()
        self.anchors |= {values["id"]} if "id" in values else set()
        self.links |= {values["href"][1:]} if values.get("href", "").startswith("#") else set()
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise ValueError(f"</{tag}> closes what is not open")


class Report(unittest.TestCase):
    """A folder of shared meshes in which one of them is found: a generated part under the name of fandisk.obj."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        base = pathlib.Path(cls.folder.name)
        (base / "shared/meshes").mkdir(parents=True)
        subprocess.run([PROGRAM, "generate", "flange", "--faces", "1500", "-o", base / "part", "--quiet"], check=True)
        subprocess.run([PROGRAM, "simplify", base / "part/flange.ply", "--faces", "1400", "-o", base / "shared/meshes/fandisk.obj",
                        "--quiet"], check=True)
        cls.out = base / "report"
        cls.done = reproduce(cls.out, "--shared", base / "shared")
        cls.report = report_of(cls.out) if cls.done.returncode == 0 else None

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    def test_every_section_is_there_and_says_something(self):
        self.assertEqual([s["id"] for s in self.report["sections"]], SECTIONS)
        markdown, page = (self.out / "report.md").read_text(), (self.out / "report.html").read_text()
        for section in self.report["sections"]:
            self.assertTrue(f"## {section['title']}\n" in markdown, section["id"])
            self.assertTrue(f'<h2 id="{section["id"]}">' in page, section["id"])
            if section["id"] != "tables":
                self.assertTrue(section["tables"] and section["pictures"], section["id"])

    def test_the_page_is_well_formed(self):
        page = Page((self.out / "report.html").read_text())
        self.assertEqual(page.open, [])
        self.assertEqual(page.links, set(SECTIONS))
        self.assertLessEqual(page.links, page.anchors)
        self.assertEqual(page.pictures, {p["file"] for s in self.report["sections"] for p in s["pictures"]})

    def test_every_table_stands_in_both_reports(self):
        markdown, page = (self.out / "report.md").read_text(), (self.out / "report.html").read_text()
        for section in self.report["sections"]:
            for table in section["tables"]:
                for row in table["rows"]:
                    self.assertTrue("| " + " | ".join(cell["text"] for cell in row) + " |" in markdown, row)
                    for cell in row:
                        if "sources" in cell:
                            self.assertTrue(f"<td>{html.escape(cell['text'])}</td>" in page, cell)

    def test_pictures_are_pictures_of_something(self):
        pictures = [p for s in self.report["sections"] for p in s["pictures"]]
        self.assertGreater(len(pictures), 60)
        for picture in pictures:
            width, height, rows = png_rows(self.out / picture["file"])
            self.assertEqual(len(rows), height * (3 * width + 1), picture)
            self.assertGreater(len(set(rows)), 30, picture)
            self.assertTrue(picture["text"])

    def test_numbers_are_those_of_the_result_files(self):
        self.assertGreater(len(list(numbers(self.report))), 300)
        self.assertEqual(wrong_numbers(self.out, self.report), [])

    def test_other_numbers_would_be_noticed(self):
        cell = next(c for c in numbers(self.report) if "/figure5/" in c["sources"][0]["file"])
        path = self.out / cell["sources"][0]["file"]
        text = path.read_text()
        try:
            result = json.loads(text)
            result["energy"]["total"] *= 1.5
            path.write_text(json.dumps(result))
            self.assertNotEqual(wrong_numbers(self.out, self.report), [])
        finally:
            path.write_text(text)

    def test_the_papers_figures_stand_beside_ours(self):
        for identifier in ("figure1", "figure5", "figure10", "figure11"):
            files = [source["file"] for s in [section_of(self.report, identifier)] for t in s["tables"] for r in t["rows"] for c in r
                     for source in c.get("sources", ())]
            self.assertIn("paper.json", files, identifier)
            self.assertTrue(any(file.startswith("runs/") for file in files), identifier)

    def test_tables_1_and_2_or_why_not(self):
        tables = section_of(self.report, "tables")
        if not pathlib.Path(TABLES).is_file():
            self.assertIn("quadseg_tables", tables["skipped"][0])
            return
        self.assertGreaterEqual(len(tables["tables"]), 3)
        for table, models in zip(tables["tables"], (("Fandisk", "Tesa", "Pawn"), ("Fandisk", "Tesa", "Cover", "Part2"))):
            self.assertEqual([row[0]["text"] for row in table["rows"]], list(models))
            ratio = table["columns"].index("paper speed-up")
            for row in table["rows"]:
                self.assertIn(row[-1]["text"], ("reached", "**missed**"))
                reached = float(row[ratio + 3]["text"]) >= float(row[ratio]["text"])
                self.assertEqual(row[-1]["text"] == "reached", reached)
                if not reached:
                    self.assertTrue(any(note.startswith(f"**{row[0]['text']}**") for note in tables["notes"]))
        self.assertTrue(any("Lamp" in text for text in tables["skipped"]))

    def test_stand_ins_are_named(self):
        for identifier in ("figure3", "figure6", "figure7", "figure8", "figure10", "figure14"):
            markdown = (self.out / "report.md").read_text()
            body = markdown.split(f"## {section_of(self.report, identifier)['title']}\n")[1].split("\n## ")[0]
            self.assertIn("**stand-in** for", body, identifier)

    def test_the_one_shared_mesh_is_used_and_the_others_are_skipped(self):
        real = section_of(self.report, "real")
        self.assertEqual([row[0]["text"] for row in real["tables"][0]["rows"]], ["fandisk"])
        self.assertEqual(len(real["pictures"]), 2)
        self.assertIn("crank.off", real["skipped"][0])
        self.assertNotIn("fandisk", real["skipped"][0])
        self.assertIn("fandisk", [row[0]["text"] for row in section_of(self.report, "figure10")["tables"][-2]["rows"]])


class Missing(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "report"

    def tearDown(self):
        self.folder.cleanup()

    def test_without_shared_meshes_stand_ins_are_used_and_the_rest_is_skipped(self):
        done = reproduce(self.out, "--shared", self.folder.name, "--only", "figure5", "figure12", "real")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = report_of(self.out)
        self.assertEqual([s["id"] for s in report["sections"]], ["figure5", "figure12", "real"])
        self.assertIn("`flange` (generated), **stand-in** for Fandisk", (self.out / "report.md").read_text())
        self.assertEqual(len(section_of(report, "figure12")["skipped"]), 2)
        skipped = section_of(report, "real")["skipped"][0]
        for mesh in ("fandisk", "crank", "joint", "casting", "lamp", "octaflower", "rockerarm", "pulley", "iron_scan", "bunny",
                     "armadillo"):
            self.assertIn(mesh, skipped)

    def test_a_program_that_fails_is_reported(self):
        done = reproduce(self.out, "--only", "figure3", program="/bin/false")
        self.assertEqual(done.returncode, 1)
        self.assertIn("exit code 1", section_of(report_of(self.out), "figure3")["skipped"][0])

    def test_an_unknown_section_is_refused(self):
        done = reproduce(self.out, "--only", "figure99")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("figure99", done.stderr)


class Program(unittest.TestCase):
    """quadseg picture and compare --picture."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.base = pathlib.Path(cls.folder.name)
        subprocess.run([PROGRAM, "generate", "flange", "--faces", "1500", "-o", cls.base, "--quiet"], check=True)
        cls.mesh = cls.base / "flange.ply"
        subprocess.run([PROGRAM, "segment", cls.mesh, "-o", cls.base / "s", "--quiet", "--pictures"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], check=False, text=True, capture_output=True)

    def picture(self, *arguments):
        path = self.base / "p.png"
        path.unlink(missing_ok=True)
        done = self.run_program("picture", self.mesh, "-o", path, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return path.read_bytes()

    def test_pictures_are_those_of_segment(self):
        labels = ("--labels", self.base / "s/labels.txt")
        self.assertEqual(self.picture(*labels), (self.base / "s/regions.png").read_bytes())
        self.assertEqual(self.picture(*labels, "--result", self.base / "s/result.json"), (self.base / "s/types.png").read_bytes())

    def test_lines_views_and_sizes_show(self):
        pictures = [self.picture(), self.picture("--sharp", 30), self.picture("--edges"), self.picture("--up", "x"),
                    self.picture("--width", 200, "--height", 100)]
        self.assertEqual(len(set(pictures)), len(pictures))
        self.assertEqual(struct.unpack(">II", pictures[-1][16:24]), (200, 100))
        self.assertEqual(self.picture("--sharp", 179.9), pictures[0])  # no edge is that sharp

    def test_wrong_labels_are_refused(self):
        short = self.base / "short.txt"
        short.write_text("0\n1\n")
        words = self.base / "words.txt"
        words.write_text("zero\n")
        for path in (short, words, self.base / "nowhere.txt"):
            done = self.run_program("picture", self.mesh, "-o", self.base / "no.png", "--labels", path)
            self.assertEqual(done.returncode, 3, path)
            self.assertIn(path.name, done.stderr)
        self.assertFalse((self.base / "no.png").exists())

    def test_a_result_of_another_run_is_refused(self):
        other = self.base / "other.json"
        for text in ('{"regions": []}', '{"regions": [{"type": "donut"}]}', "{", '{"regions": 3}'):
            other.write_text(text)
            done = self.run_program("picture", self.mesh, "-o", self.base / "no.png", "--labels", self.base / "s/labels.txt",
                                    "--result", other)
            self.assertEqual(done.returncode, 3, text)
            self.assertIn("other.json", done.stderr)

    def test_errors_are_coloured_and_none_are_blue(self):
        same, moved = self.base / "same.png", self.base / "moved.png"
        simplified = self.base / "simple.off"
        self.run_program("simplify", self.mesh, "-o", simplified, "--faces", 200, "--quiet")
        for path, other in ((same, self.mesh), (moved, simplified)):
            done = self.run_program("compare", self.mesh, other, "--picture", path, "--picture-scale", 1e-3)
            self.assertEqual(done.returncode, 0, done.stderr)
        sys.path.insert(0, str(ROOT / "tools/reproduce"))
        import png  # pylint: disable=import-outside-toplevel

        def red_pixels(path):
            image = png.read(path)[:, :1000].astype(int)  # without the scale
            return int(((image[..., 0] > 2 * image[..., 1] + 40) & (image[..., 0] > 2 * image[..., 2] + 40)).sum())

        self.assertEqual(red_pixels(same), 0)
        self.assertGreater(red_pixels(moved), 100)


if __name__ == "__main__":
    unittest.main()
