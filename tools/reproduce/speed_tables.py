"""Tables 1 and 2: the speed-up by features and by simplification, through bench/tables."""
import json
import pathlib
import subprocess
import sys

from document import Number, Ratio, Section
from workshop import ROOT, Failed, Missing

MANIFEST = ROOT / "bench/tables/manifests/paper.json"


def manifest_for(kit):
    """The manifest of the benchmark suite; small meshes and one run where it has to be quick."""
    manifest = json.loads(MANIFEST.read_text())
    if kit.quick:
        for mesh in manifest["meshes"].values():
            if "generator" in mesh:
                mesh["faces"] = 1500
        for table in manifest["tables"]:
            table["runs"] = 1
    return manifest


def run_tables(kit, program):
    """Runs quadseg_tables; the folder with its JSON."""
    if program is None or not pathlib.Path(program).exists():
        raise Missing("the program quadseg_tables (--tables), a target of builds with QUADSEG_BUILD_BENCH")
    folder = kit.out / "runs/tables"
    folder.mkdir(parents=True, exist_ok=True)
    manifest = folder / "manifest.json"
    manifest.write_text(json.dumps(manifest_for(kit), indent=1) + "\n")
    command = [str(pathlib.Path(program).resolve()), str(manifest), "--out", str(folder / "out"), "--program", kit.program]
    if kit.shared is not None:
        command += ["--shared", str(kit.shared)]
    done = subprocess.run(command, check=False, text=True, capture_output=True)
    (folder / "log.txt").write_text(done.stdout + done.stderr)
    result = folder / "out/manifest.json"
    if not result.exists():
        raise Failed(f"quadseg_tables: {done.stderr.strip()[-300:]}")
    if done.returncode != 0:
        print("quadseg_tables: a job failed or ran out of time, see", folder / "log.txt", file=sys.stderr)
    return pathlib.Path("runs/tables/out/manifest.json")


def job_index(table, row, variant):
    for i, job in enumerate(table["jobs"]):
        if job["mesh"] == row["mesh"] and job.get("variant") == variant and job["arguments"] == row["arguments"][variant]:
            if job["exit_code"] == 0:
                return i
    return None


def mesh_text(source):
    text = source.get("file", "").rsplit("/", 1)[-1] or f"`{source['generator']}` (generated)"
    if source.get("noise"):
        text += f", noise {source['noise']:g}"
    return text + (f", **stand-in** for {source['stands_for']}" if "stands_for" in source else "")


def shares(seconds):
    """Where a run's wall time went."""
    total = max(seconds["total"], 1e-9)
    named = {"simplified mesh": seconds["coarse"], "loop on the input": seconds["fine"],
             "final fits and types": seconds["post"],
             "reading, preparing, writing": seconds["read"] + seconds["prepare"] + seconds["write"]}
    return ", ".join(f"{100 * value / total:.0f} % {name}" for name, value in named.items() if value > 0)


def comparison(kit, file, manifest, name, section, reasons):
    """The paper's seconds and ours, the speed-up of both, and why where ours is smaller."""
    result = json.loads((kit.out / file).read_text())
    t = next(i for i, table in enumerate(result["tables"]) if table["name"] == name)
    wanted = next(table for table in manifest["tables"] if table["name"] == name)
    first, second = wanted["variants"]
    table = section.table(["model", "mesh", "faces", "regions: paper", "regions: ours", f"paper s: {first}", f"paper s: {second}",
                           "paper speed-up", f"our CPU s: {first}", f"our CPU s: {second}", "our speed-up",
                           "paper s / ours: " + second, f"E: {first}", f"E: {second}", "speed-up"])
    number = lambda path, pattern="%.3g": Number(kit.out, file, path, pattern)
    missed = []
    for r, row in enumerate(wanted["rows"]):
        source = manifest["meshes"][row["mesh"]]
        a, b = (job_index(result["tables"][t], row, v) for v in (first, second))
        if a is None or b is None:
            section.skipped(row["model"], f"{mesh_text(source)} is not there" if "file" in source else "a run failed")
            continue
        paper_a, paper_b = (number(f"tables/{t}/paper/{r}/{v}") for v in (first, second))
        job = f"tables/{t}/jobs/"
        cpu_a, cpu_b = number(f"{job}{a}/cpu/median"), number(f"{job}{b}/cpu/median")
        paper_ratio, ratio = Ratio(paper_a, paper_b), Ratio(cpu_a, cpu_b)
        holds = ratio.value >= paper_ratio.value
        if not holds:
            missed.append((row, mesh_text(source), ratio, paper_ratio, shares(result["tables"][t]["jobs"][b]["seconds"])))
        table.add(row["model"], mesh_text(source), number(f"{job}{a}/faces", "%d"), number(f"tables/{t}/paper/{r}/regions", "%d"),
                  number(f"{job}{a}/regions", "%d"), paper_a, paper_b, paper_ratio, cpu_a, cpu_b, ratio, Ratio(paper_b, cpu_b),
                  number(f"{job}{a}/energy"), number(f"{job}{b}/energy"), "reached" if holds else "**missed**")
    for row, mesh, ratio, paper_ratio, parts in missed:
        reason = reasons.get(f"{name}: {row['model']}", "No reason is known.")
        if kit.quick:
            reason = "Quick mode: meshes too small for what the paper measures."
        section.note(f"""**{row['model']}** ({mesh}): {ratio.text} times faster, the paper {paper_ratio.text} times. {reason}
                     ({second}: {parts}.)""")


def section(kit, reasons, program):
    section = Section("tables", "Tables 1 and 2: features and simplification")
    section.text("""Preset `paper`, one thread, CPU seconds from program start to written files (median of the runs of
        `bench/tables/manifests/paper.json`). The paper's seconds are those of a Xeon at 2.66 GHz of 2012 and of its own code:
        what can be compared is the speed-up; `paper s / ours` tells how much sooner a user has the result.""")
    try:
        file = run_tables(kit, program)
    except (Missing, Failed) as problem:
        section.skipped("Tables 1 and 2", str(problem))
        return section
    manifest = json.loads((kit.out / "runs/tables/manifest.json").read_text())
    names = [table["name"] for table in manifest["tables"] if "rows" in table]
    for name in names:
        section.text(f"**{name}**. " + next(table["caption"] for table in manifest["tables"] if table["name"] == name))
        comparison(kit, file, manifest, name, section, reasons)
    default_table(kit, file, manifest, section)
    return section


def default_table(kit, file, manifest, section):
    result = json.loads((kit.out / file).read_text())
    t = next(i for i, table in enumerate(result["tables"]) if table["name"] == "Default preset")
    section.text("**The same meshes and numbers of regions through the default preset**, which is not the paper's loop:")
    table = section.table(["mesh", "faces", "regions", "CPU s", "E", "RMS"])
    for i, job in enumerate(result["tables"][t]["jobs"]):
        if job["exit_code"] != 0:
            continue
        number = lambda key, pattern="%.3g", i=i: Number(kit.out, file, f"tables/{t}/jobs/{i}/{key}", pattern)
        table.add(mesh_text(manifest["meshes"][job["mesh"]]), number("faces", "%d"), number("regions", "%d"), number("cpu/median"),
                  number("energy"), number("rms", "%.2e"))
