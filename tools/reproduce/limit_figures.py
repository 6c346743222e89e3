"""Figures 9, 14 and 15: smoothing of borders, noise, and a model that quadrics suit badly."""
import numpy as np

import mesh_files
from document import Ratio, Section
from workshop import Missing

PAPER = ("--preset", "paper")


def smoothing(kit, reasons):
    section = Section("figure9", "Figs. 4 and 9: smoothing of borders")
    model = kit.shared_or("bunny.obj", lambda: kit.generated("fillets", 30000, noise=5e-4, stands_for="Bunny"))
    regions = 60 if not model.stands_for else kit.surfaces_of(model)
    up = () if model.stands_for else ("--up", "y")
    section.text(f"""Model: {model.text}, {regions} regions. Length: of all borders, in diagonals. Zigzag: mean turning angle at border
        vertices. The paper shows pictures only.""")
    table = section.table(["preset", "band", "length before", "after", "after / before", "zigzag before, degrees", "after ",
                           "after / before ", "E without", "E with", "CPU s"])
    figure = section.figure(290)
    for preset, options in (("default", ()), ("paper", (*PAPER, "--coarse", 300 if kit.quick else 5000, "--features", "none"))):
        plain = kit.segment(f"figure9_{preset}", model, *options, "--regions", regions)
        figure.add(kit.regions_picture(plain, model, *up), f"{preset}: before")
        for band in (2, 5):
            run = kit.segment(f"figure9_{preset}_{band}", model, *options, "--regions", regions, "--smooth", "--smooth-band", band)
            length = [run.number(f"borders/{when}/length") for when in ("before", "after")]
            zigzag = [run.number(f"borders/{when}/zigzag") for when in ("before", "after")]
            table.add(preset, str(band), *length, Ratio(*reversed(length)), *zigzag, Ratio(*reversed(zigzag)),
                      plain.number("energy/total"), run.number("energy/total"), run.cpu)
            figure.add(kit.regions_picture(run, model, *up), f"{preset}: after, band of {band} faces")
    section.note(reasons["figure 9"])
    return section


def overlap(truth, labels, weights):
    """Area shared by every true surface and region."""
    shared = np.zeros((truth.max() + 1, labels.max() + 1))
    np.add.at(shared, (truth, labels), weights)
    return shared


def mean_best_iou(shared):
    union = shared.sum(1)[:, None] + shared.sum(0)[None, :] - shared
    return float((shared / union).max(axis=1).mean())


def noise(kit, reasons):
    section = Section("figure14", "Fig. 14: noise")
    section.text("""The paper: Carter with noise, 100K faces, 39 patches, through simplification. Here: a part with known
        surfaces; IoU is the mean over the true surfaces of the best overlap (by area) that any region reaches.""")
    table = section.table(["model", "preset", "regions: true", "regions: ours", "IoU", "noise estimated", "RMS", "CPU s"])
    figure = section.figure(290)
    for level in (0, 2e-4, 1e-3):
        model = kit.generated("flange", 100000, noise=level, stands_for="Carter")
        truth = np.array(kit.truth_of(model))
        weights = mesh_files.areas(*mesh_files.read(model.path))
        true_count = int(truth.max()) + 1
        for preset, options in (("paper", (*PAPER, "--regions", true_count, "--coarse", 500 if kit.quick else 5000)), ("default", ())):
            run = kit.segment(f"figure14_{preset}_{level:g}", model, *options)
            shared = overlap(truth, np.loadtxt(run.labels, dtype=np.int64), weights)
            number = kit.write_result(f"figure14_{preset}_{level:g}_truth", {"true regions": true_count, "iou": mean_best_iou(shared)})
            table.add(model.text, preset, number("true regions", "%d"), run.regions, number("iou"), run.number("noise", "%.1e"),
                      run.number("rms", "%.2e"), run.cpu)
            if level:
                figure.add(kit.regions_picture(run, model),
                           f"noise {level:g}, preset {preset}: {run.regions.text} regions, IoU {number('iou').text}")
    try:
        model = kit.from_shared("sharp_sphere_noisy.obj", "Carter")
        run = kit.segment("figure14_sphere", model)
        table.add(model.text, "default", "–", run.regions, "–", run.number("noise", "%.1e"), run.number("rms", "%.2e"), run.cpu)
        figure.add(kit.regions_picture(run, model), f"{model.name}: {run.regions.text} regions")
    except Missing as problem:
        section.skipped("sharp_sphere_noisy", str(problem))
    section.note(reasons["figure 14"])
    return section


def own_regions(shared, surfaces):
    """How many of the surfaces lie to 90 % in a region in which no other of them has its largest part."""
    main = shared[surfaces].argmax(axis=1)
    inside = shared[surfaces, main] >= 0.9 * shared[surfaces].sum(axis=1)
    return int(sum(inside[i] and (main == main[i]).sum() == 1 for i in range(len(surfaces))))


def octahedron(kit, reasons):
    section = Section("figure15", "Fig. 15: rounded octahedron, planes against quadrics")
    model = kit.generated("rounded_octahedron", 20000)
    truth = np.array(kit.truth_of(model))
    weights = mesh_files.areas(*mesh_files.read(model.path))
    eight = (*PAPER, "--regions", 8, "--features", "none")
    runs = [("eight planes", kit.segment("figure15_planes", model, *eight, "--method", "vsa_l21")),
            ("eight quadrics, preset paper", kit.segment("figure15_quadrics", model, *eight)),
            ("default preset, no options", kit.segment("figure15_default", model))]
    table = section.table(["", "regions", "flat faces with a region of their own (of 8)", "mean best IoU with the 26 true surfaces",
                           "E", "RMS", "CPU s"])
    figure = section.figure(290)
    for text, run in runs:
        shared = overlap(truth, np.loadtxt(run.labels, dtype=np.int64), weights)
        flat = np.argsort(-shared.sum(axis=1), kind="stable")[:8]
        number = kit.write_result(run.folder.name + "_truth", {"own": own_regions(shared, flat), "iou": mean_best_iou(shared)})
        table.add(text, run.regions, number("own", "%d"), number("iou"), run.number("energy/total"), run.number("rms", "%.2e"),
                  run.cpu)
        figure.add(kit.regions_picture(run, model), f"{text}: {run.regions.text} regions")
    figure.add(kit.types_picture(runs[2][1], model), "default preset: types")
    section.note(reasons["figure 15"])
    return section
