"""Figures 10 to 13: the paper's method against the others."""
import json
import math

import numpy as np

import implicit
import mesh_files
from document import Number, Ratio, Section
from workshop import Missing, Model

PAPER = ("--preset", "paper")
METHODS = {"planes": "vsa_l21", "hybrid": "hybrid", "quadrics, distance only": "quadric_l2"}
SOURCES = {"planes": "planes [6]", "hybrid": "plane, sphere, cylinder [10]", "quadrics, distance only": "quadrics, distance only [14]"}
ERROR_SCALE = 2e-3


class ErrorTable:
    """Fig. 10 for one model: every method at its number of regions, with and without features, the better one shown."""

    def __init__(self, kit, section, name, model):
        self.kit, self.name, self.model = kit, name, model
        section.text(f"Model: {model.text}.")
        self.table = section.table(["method", "regions", "Hausdorff RMS", "RMS", "largest", "E", "CPU s", "ours (paper) is better by",
                                    "ours (default) is better by"])

    def best(self, method, regions):
        tried = []
        for features in ("none", "30"):
            label = f"{self.name}_{method}_{regions}_{features}"
            run = self.kit.segment(label, self.model, *PAPER, "--method", method, "--regions", regions, "--features", features,
                                   "--project")
            tried.append((self.kit.hausdorff(run, self.model)[0], run))
        return min(tried, key=lambda t: t[0].value)

    def default(self, regions):
        label = f"{self.name}_default_{regions}"
        run = self.kit.segment(label, self.model, *(("--regions", regions) if regions else ()), "--project")
        return self.kit.hausdorff(run, self.model)[0], run

    def row(self, text, measured, ours):
        rms, run = measured
        self.table.add(text, run.regions, rms, run.number("rms", "%.2e"), run.number("max", "%.2e"), run.number("energy/total"),
                       run.cpu, *(Ratio(rms, own[0]) if own else "" for own in ours))

    def add(self, regions, more=(), itself=False):
        """Every method at `regions`; `more`: others at their own numbers. Returns the RMS of each method and of ours."""
        ours = self.best("quadric", regions), self.default(0 if itself else regions)
        rivals = {m: self.best(METHODS[m], regions) for m in METHODS}
        for method, count in more:
            self.row(SOURCES[method] + ", as many as in the paper", self.best(METHODS[method], count), ours)
        for method, measured in rivals.items():
            self.row(SOURCES[method], measured, ours)
        self.row("**ours, preset paper**", ours[0], (None, None))
        self.row("**ours, preset default**" + (", no options" if itself else ", `--regions`"), ours[1], (None, None))
        return rivals, ours

    def pictures(self, figure, rivals, ours):
        shown = [(SOURCES[m], r) for m, r in rivals.items()] + [("ours, preset paper", ours[0]), ("ours, preset default", ours[1])]
        for text, (_, run) in shown:
            figure.add(self.kit.regions_picture(run, self.model), f"{text}: {run.regions.text} regions")
        for text, (rms, run) in shown:
            _, picture = self.kit.hausdorff(run, self.model, ERROR_SCALE)
            figure.add(picture, f"{text}: errors, Hausdorff RMS {rms.text} of the diagonal (red: {ERROR_SCALE:g})")


def claims(kit, section, cases):
    """The paper's factors beside ours."""
    section.text("""**The claim**: by how much our RMS is below the others' at equal numbers of regions. The paper's factors compare
        80 planes and 24 hybrid proxies with 22 quadrics (Tesa).""")
    table = section.table(["model", "regions", "against", "paper's factor", "ours, preset paper", "", "ours, preset default", ""])
    for model, (rivals, ours) in cases:
        for method, (rms, run) in rivals.items():
            bound = kit.paper(f"figure 10/factors/{method}")
            ratios = [Ratio(rms, own[0]) for own in ours]
            verdicts = ["reached" if ratio.value >= bound.value else "**missed**" for ratio in ratios]
            table.add(model.name, run.regions, SOURCES[method], bound, ratios[0], verdicts[0], ratios[1], verdicts[1])


def weights(kit, section, name, model, regions, rival):
    section.text(f"""**The weight of the normals** ({model.name}, {regions} regions). At ω = .5 normals are 99 % of the
        energy (for noisy vertices the weight of greatest likelihood is half of the squared edge length, here about 5e-5): regions go where normals
        turn. With less weight the same methods spend them where distances are.""")
    table = section.table(["ω", "preset paper: Hausdorff RMS", "better than distance only by", "preset default: Hausdorff RMS",
                           "better than distance only by "])
    for weight in ("0.5", "0.05", "0.005", "0.0005", "0.00005"):
        cells = [weight]
        for preset, options in (("paper", (*PAPER, "--features", "none")), ("default", ())):
            run = kit.segment(f"{name}_{preset}_w{weight}", model, *options, "--regions", regions, "--weight", weight, "--project")
            rms, _ = kit.hausdorff(run, model)
            cells += [rms, Ratio(rival[0], rms)]
        table.add(*cells)


def errors(kit, reasons):
    section = Section("figure10", "Fig. 10: approximation errors")
    section.text("""Symmetric Hausdorff distance (as Metro measures it, RMS relative to the diagonal) between the mesh and its
        vertices projected onto the fitted surfaces; `RMS` is that of the exact distances of the vertices. Every variational method
        shares the loop of preset `paper` and is run with and without features of 30 degrees: the better result is shown.
        In the paper (Tesa): 80 planes 2.1e-2, 24 hybrid proxies 2.8e-2, 22 quadrics by distance 5.9e-3, ours 3.3e-3.""")
    cases = []
    tesa = kit.generated("flange", 22000, stands_for="Tesa")
    table = ErrorTable(kit, section, "figure10_tesa", tesa)
    result = table.add(kit.surfaces_of(tesa), (("planes", 80), ("hybrid", 24)), itself=True)
    table.pictures(section.figure(215), *result)
    cases.append((tesa, result))
    quadrics = kit.generated("quadrics", 20000, stands_for="a part of general quadrics")
    table = ErrorTable(kit, section, "figure10_quadrics", quadrics)
    result = table.add(kit.surfaces_of(quadrics))
    table.pictures(section.figure(215), *result)
    cases.append((quadrics, result))
    try:
        fandisk = kit.from_shared("fandisk.obj")
        table = ErrorTable(kit, section, "figure10_fandisk", fandisk)
        result = table.add(22, (("planes", 80), ("hybrid", 24)))
        table.pictures(section.figure(215), *result)
        cases.append((fandisk, result))
        found = kit.segment("figure10_found", fandisk).regions.value
        result = table.add(found, itself=True)
        cases.append((fandisk, result))
    except Missing as problem:
        fandisk = None
        section.skipped("fandisk", str(problem))
    claims(kit, section, cases)
    if fandisk is not None:
        weights(kit, section, "figure10_weight", fandisk, 22, cases[2][1][0]["quadrics, distance only"])
    section.note(reasons["figure 10"])
    return section


def fit_rms(run, positions, triangles):
    """RMS distance of the loop's proxy from the triangles, relative to the diagonal: from E_d, which is in the unit cube."""
    extent = positions.max(0) - positions.min(0)
    area = mesh_files.areas(positions, triangles).sum() / extent.max() ** 2
    return math.sqrt(run.result["energy"]["distance"] / area) * extent.max() / np.linalg.norm(extent)


def overlay(kit, name, run, positions, triangles):
    """Mesh and fitted surface in two colours."""
    low, high = positions.min(0), positions.max(0)
    margin = 0.12 * (high - low).max()
    fitted = implicit.zero_set(run.result["regions"][0]["coefficients"], low - margin, high + margin, 24 if kit.quick else 64)
    both = mesh_files.joined([(positions, triangles), fitted])
    base = kit.out / "meshes" / name
    mesh_files.write_off(f"{base}.off", both[0], both[1])
    np.savetxt(f"{base}.txt", both[2], fmt="%d")
    return kit.picture(name, f"{base}.off", "--labels", f"{base}.txt", "--up", "z")


def fits(kit, reasons):
    section = Section("figure11", "Fig. 11: quadric fits against the unnormalised gradient fit [46]")
    section.text("""Meshes sampled from quadrics, one region, preset `paper`. `fit` is the RMS distance of the loop's proxy, the same
        first-order distance integrated over the triangles for both; `surface` that of the vertices from the surface that is
        reported, which ours refits to the vertices (section 4.4.2). In the pictures the first colour is the mesh, the second
        the fitted surface.""")
    table = section.table(["shape", "faces", "[46]: fit", "ours: fit", "[46] / ours", "[46]: surface", "ours: surface", "[46] / ours ",
                           "paper, at least", ""])
    figure = section.figure(200)
    for shape, make in implicit.SHAPES.items():
        positions, triangles = make(8 if kit.quick else 24)
        path = kit.out / "meshes" / f"figure11_{shape.replace(' ', '_')}.off"
        mesh_files.write_off(path, positions, triangles)
        model = Model(path, shape)
        base = path.stem
        runs = {m: kit.segment(f"{base}_{m}", model, *PAPER, "--regions", 1, "--features", "none", "--method", m)
                for m in ("quadric_gradient", "quadric")}
        number = kit.write_result(f"{base}_fit", {m: fit_rms(r, positions, triangles) for m, r in runs.items()})
        theirs, ours = number("quadric_gradient", "%.2e"), number("quadric", "%.2e")
        ratio, bound = Ratio(theirs, ours), kit.paper("figure 11/factor")
        rms = {m: r.number("rms", "%.2e") for m, r in runs.items()}
        table.add(shape, runs["quadric"].faces, theirs, ours, ratio, rms["quadric_gradient"], rms["quadric"],
                  Ratio(rms["quadric_gradient"], rms["quadric"]), bound,
                  "reached" if min(ratio.value, Ratio(rms["quadric_gradient"], rms["quadric"]).value) >= bound.value else
                  "**missed by the fit**" if ratio.value < bound.value else "**missed**")
        figure.add(kit.picture(f"{base}_input", path, "--up", "z", "--edges"), f"{shape}: mesh")
        for m, text in (("quadric_gradient", "[46]"), ("quadric", "ours")):
            figure.add(overlay(kit, f"{base}_{m}_overlay", runs[m], positions, triangles), f"{shape}: {text}")
    section.note(reasons["figure 11"])
    return section


def merging(kit, reasons):
    section = Section("figure12", "Figs. 12 and 13: against hierarchical merging of primitives [22]")
    section.text("""Method `hierarchical` of preset `paper` (planes, spheres, cylinders, merged from single faces) beside ours at the
        same number of regions. Fig. 13 compares with another merging method [20] on Part3; the same one stands for it here.""")
    models = [(kit.generated("fillets", 20000, stands_for="the models of Fig. 12"), None)]
    for file, regions, stands_for in (("fandisk.obj", 22, "the models of Fig. 12"), ("rockerarm.off", 11, "Part3 (Fig. 13)")):
        try:
            models.append((kit.from_shared(file, stands_for), regions))
        except Missing as problem:
            section.skipped(file, str(problem))
    table = section.table(["model", "method", "regions", "E", "E / ours (paper)", "RMS", "CPU s"])
    for i, (model, regions) in enumerate(models):
        regions = regions or kit.surfaces_of(model)
        name = f"figure12_{i}"
        variants = (("merging of primitives [22]", "merging", (*PAPER, "--method", "hierarchical")),
                    ("**ours, preset paper**", "paper", PAPER), ("**ours, preset default**", "default", ()))
        runs = [(text, kit.segment(f"{name}_{label}", model, *options, "--regions", regions)) for text, label, options in variants]
        figure = section.figure(290)
        for text, run in runs:
            energy = run.number("energy/total")
            table.add(model.text, text, run.regions, energy, Ratio(energy, runs[1][1].number("energy/total")),
                      run.number("rms", "%.2e"), run.cpu)
            figure.add(kit.regions_picture(run, model), f"{model.name}: {text.strip('*')}, {run.regions.text} regions")
    section.note(reasons["figure 12"])
    return section
