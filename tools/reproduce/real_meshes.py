"""Real meshes through the default preset, with what a CAD engineer would object to."""
import collections

from document import Section
from workshop import Missing

MESHES = {"fandisk.obj": (), "crank.off": (), "joint.obj": (), "casting.obj": (), "lamp.off": (), "octaflower.obj": (),
          "rockerarm.off": (), "pulley.obj": (), "iron_scan.ply": (), "bunny.obj": ("--up", "y"), "armadillo.obj": ("--up", "y")}


def type_counts(run):
    counts = collections.Counter(region["type"].replace("_", " ") for region in run.result["regions"])
    return ", ".join(f"{n} {t}" for t, n in sorted(counts.items(), key=lambda item: (-item[1], item[0])))


def section(kit, notes):
    section = Section("real", "Real meshes")
    section.text("Default preset, no options. Seconds are wall time from program start to written files, on this machine.")
    table = section.table(["mesh", "faces", "regions", "types", "RMS", "wall s", "CPU s"])
    missing = []
    for file, view in MESHES.items():
        try:
            model = kit.from_shared(file)
        except Missing:
            missing.append(file)
            continue
        run = kit.segment("real_" + model.name, model)
        table.add(model.name, run.faces, run.regions, type_counts(run), run.number("rms", "%.2e"), run.measured("wall"), run.cpu)
        types = type_counts(run)
        section.text(f"**{model.name}**: {run.faces.text} faces, {run.regions.text} regions ({types}), {run.measured('wall').text} s")
        figure = section.figure(500)
        figure.add(kit.regions_picture(run, model, *view), "regions")
        figure.add(kit.types_picture(run, model, *view), "types")
        section.note(notes.get(model.name, "Not looked at yet."))
    if missing:
        section.skipped(", ".join(missing), "not there; --shared names the folder of shared meshes")
    return section
