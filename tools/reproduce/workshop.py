"""Runs the program and keeps what it wrote: every run in a folder of its own below runs/, with its CPU seconds."""
import json
import os
import pathlib
import subprocess
import time

from document import Number

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class Missing(Exception):
    """A mesh that is not there, or a program."""


class Failed(Exception):
    """A run that did not end well."""


class Model:
    """A mesh: what it stands for in the paper, and what it is."""

    def __init__(self, path, name, stands_for=""):
        self.path = pathlib.Path(path)
        self.name = name
        self.stands_for = stands_for

    @property
    def text(self):
        return f"{self.name}, **stand-in** for {self.stands_for}" if self.stands_for else self.name


class Run:
    """A result folder: Numbers out of result.json and of what was measured about it."""

    def __init__(self, workshop, folder):
        self.workshop = workshop
        self.folder = pathlib.Path(folder)
        self.result = json.loads((workshop.out / self.folder / "result.json").read_text())

    def number(self, path, pattern="%.3g"):
        return Number(self.workshop.out, self.folder / "result.json", path, pattern)

    def measured(self, path, pattern="%.3g"):
        return Number(self.workshop.out, self.folder / "run.json", path, pattern)

    @property
    def regions(self):
        return self.number("regions", "%d")

    @property
    def faces(self):
        return self.number("input/faces", "%d")

    @property
    def cpu(self):
        return self.measured("cpu", "%.3g")

    @property
    def labels(self):
        return self.workshop.out / self.folder / "labels.txt"


class Workshop:
    def __init__(self, out, program, shared, quick):
        self.out = pathlib.Path(out)
        self.program = str(pathlib.Path(program).resolve())
        self.shared = shared
        self.quick = quick
        for folder in ("runs", "meshes", "pictures"):
            (self.out / folder).mkdir(parents=True, exist_ok=True)

    def call(self, arguments):
        """Runs the program; its output, wall and CPU seconds."""
        start = time.monotonic()
        process = subprocess.Popen([self.program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise Failed(f"quadseg {' '.join(map(str, arguments))}: exit code {process.returncode}: "
                         f"{output.decode(errors='replace').strip()}")
        return output.decode(), time.monotonic() - start, usage.ru_utime + usage.ru_stime

    def generated(self, generator, faces, noise=0.0, seed=1, stands_for=""):
        if self.quick:
            faces = max(1200, faces // 15)
        folder = self.out / "meshes" / f"{generator}_{faces}_{noise:g}_{seed}"
        path = folder / f"{generator}.ply"
        if not path.exists():
            self.call(["generate", generator, "--faces", faces, "--noise", noise, "--seed", seed, "-o", folder, "--quiet"])
        text = f"`{generator}` (generated" + (f", noise {noise:g})" if noise else ")")
        return Model(path, text, stands_for)

    def from_shared(self, file, stands_for=""):
        if self.shared is None:
            raise Missing(f"{file} needs the folder of shared meshes (--shared DIR), which is not there")
        path = pathlib.Path(self.shared) / "meshes" / file
        if not path.exists():
            raise Missing(f"{file} is not in the folder of shared meshes")
        return Model(path, file.rsplit(".", 1)[0], stands_for)

    def shared_or(self, file, stand_in, stands_for=""):
        """The shared mesh, or what `stand_in` makes instead."""
        try:
            return self.from_shared(file, stands_for)
        except Missing:
            return stand_in()

    def truth_of(self, model):
        """The true label of every face of a generated mesh."""
        text = model.path.with_suffix("").with_suffix(".gt.json").read_text()
        return json.loads(text)["surface_group"]

    def surfaces_of(self, model):
        text = model.path.with_suffix("").with_suffix(".gt.json").read_text()
        return len(json.loads(text)["groups"])

    def segment(self, name, model, *arguments):
        folder = pathlib.Path("runs") / name
        command = ["segment", model.path, "-o", self.out / folder, "--quiet", "--no-write-types", "--no-write-regions",
                   *arguments]
        _, wall, cpu = self.call(command)
        shown = " ".join(["quadseg", "segment", model.path.name, *map(str, arguments)])
        (self.out / folder / "run.json").write_text(json.dumps({"command": shown, "cpu": cpu, "wall": wall}, indent=1) + "\n")
        return Run(self, folder)

    def picture(self, name, mesh, *arguments):
        path = f"pictures/{name}.png"
        width = 380 if self.quick else 760
        self.call(["picture", mesh, "-o", self.out / path, "--width", width, "--height", width * 3 // 4, *arguments])
        return path

    def regions_picture(self, run, model, *arguments):
        return self.picture(run.folder.name + "_regions", model.path, "--labels", run.labels, *arguments)

    def types_picture(self, run, model, *arguments):
        return self.picture(run.folder.name + "_types", model.path, "--labels", run.labels, "--result",
                            self.out / run.folder / "result.json", *arguments)

    def hausdorff(self, run, model, scale=None):
        """Metro's measure between the mesh and its projection onto the surfaces (needs a run with --project); with
        `scale` a picture of the errors as well. Writes compare.json beside the result."""
        picture = f"pictures/{run.folder.name}_errors.png"
        extra = [] if scale is None else ["--picture", self.out / picture, "--picture-scale", scale]
        samples = 20000 if self.quick else 200000
        output, _, _ = self.call(["compare", model.path, self.out / run.folder / "projected.ply", "--json", "--samples",
                                  samples, *extra])
        file = run.folder / "compare.json"
        (self.out / file).write_text(output)
        return Number(self.out, file, "symmetric/relative/rms", "%.2e"), picture

    def write_result(self, name, data):
        """A result file of ours, for Numbers."""
        file = pathlib.Path("runs") / f"{name}.json"
        (self.out / file).write_text(json.dumps(data, indent=1) + "\n")
        return lambda path, pattern="%.3g": Number(self.out, file, path, pattern)

    def paper(self, path, pattern="%g"):
        return Number(self.out, "paper.json", path, pattern)
