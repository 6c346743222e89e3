"""Reproduces the tables and figures of the paper; see run."""
import argparse
import json
import os
import pathlib
import shutil
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import comparison_figures  # noqa: E402
import limit_figures  # noqa: E402
import process_figures  # noqa: E402
import real_meshes  # noqa: E402
import speed_tables  # noqa: E402
from document import Document, Section  # noqa: E402
from workshop import HERE, ROOT, Failed, Missing, Workshop  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(prog="tools/reproduce/run", description="Reproduces the tables and figures of the paper into "
                                     "one folder: report.md, report.html, report.json, pictures, the result files of all runs.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/reproduce", help="folder to write (default out/reproduce)")
    parser.add_argument("--shared", type=pathlib.Path, help="folder with meshes/: the models that can't be generated (default: "
                        "../shared where it is there)")
    parser.add_argument("--program", help="the program quadseg; then nothing is built")
    parser.add_argument("--tables", help="the program quadseg_tables (Tables 1 and 2)")
    parser.add_argument("--quick", action="store_true", help="small generated meshes; shared ones only where --shared is given")
    parser.add_argument("--only", nargs="+", metavar="SECTION", help="sections by identifier, e.g. tables figure10 real")
    parser.add_argument("--copy", action="store_true", help="also write the tables to tools/reproduce/REPORT.md and three small "
                        "pictures to datasets/pictures")
    return parser.parse_args()


def sections(kit, reasons, notes, tables):
    """In the order of the paper: identifier → what makes the section."""
    return {
        "tables": lambda: speed_tables.section(kit, reasons, tables),
        "figure1": lambda: process_figures.crank(kit),
        "figure3": lambda: process_figures.progressive_insertion(kit),
        "figure5": lambda: process_figures.features(kit),
        "figure6": lambda: process_figures.bone(kit),
        "figure7": lambda: process_figures.lamp(kit),
        "figure8": lambda: process_figures.part2(kit),
        "figure9": lambda: limit_figures.smoothing(kit, reasons),
        "figure10": lambda: comparison_figures.errors(kit, reasons),
        "figure11": lambda: comparison_figures.fits(kit, reasons),
        "figure12": lambda: comparison_figures.merging(kit, reasons),
        "figure14": lambda: limit_figures.noise(kit, reasons),
        "figure15": lambda: limit_figures.octahedron(kit, reasons),
        "real": lambda: real_meshes.section(kit, notes),
    }


def shared_folder(wanted, quick):
    if wanted is not None:
        return wanted if (wanted / "meshes").is_dir() else None
    default = ROOT.parent / "shared"
    return default if not quick and (default / "meshes").is_dir() else None


def main():
    a = arguments()
    if a.program is None:
        sys.exit("tools/reproduce/run builds the programs; here --program is needed")
    if a.copy and a.quick:
        sys.exit("--copy keeps whole reports only, not those of --quick")
    start = time.monotonic()
    shared = shared_folder(a.shared, a.quick)
    kit = Workshop(a.out, a.program, shared, a.quick)
    shutil.copy(HERE / "paper.json", kit.out / "paper.json")
    texts = json.loads((HERE / "notes.json").read_text())
    makers = sections(kit, texts["reasons"], texts["real meshes"], a.tables)
    unknown = sorted(set(a.only or ()) - set(makers))
    if unknown:
        sys.exit(f"no section {', '.join(unknown)}; there are {', '.join(makers)}")
    document = Document("The paper's tables and figures, reproduced", [
        "D.-M. Yan, W. Wang, Y. Liu, Z. Yang: *Variational mesh segmentation via quadric surface fitting*, Computer-Aided Design 44 "
        "(2012), beside this program. Every number of ours is read from a result file of the run that made this report "
        "(`report.json` names file and key). Energies are at ω = .5 in the unit cube, RMS distances relative to the diagonal.",
        "Models that are not to be had are replaced by **stand-ins** of the same kind and size, named as such."])
    failures = 0
    for identifier, make in makers.items():
        if a.only and identifier not in a.only:
            continue
        begin = time.monotonic()
        try:
            section = make()
        except (Missing, Failed) as problem:
            section = Section(identifier, identifier)
            section.skipped("this section", str(problem))
            failures += isinstance(problem, Failed)
        document.sections.append(section)
        print(f"{identifier}: {time.monotonic() - begin:.1f} s", file=sys.stderr, flush=True)
    seconds = time.monotonic() - start
    document.introduction.append(
        f"Made in {seconds:.0f} s with {os.cpu_count()} cores" + (", quick mode: small meshes" if a.quick else "") +
        ("." if shared is not None else "; without the folder of shared meshes: generated stand-ins only."))
    document.write(kit.out)
    if a.copy:
        from copies import write_copies  # pylint: disable=import-outside-toplevel
        write_copies(document, kit)
    print(f"{kit.out / 'report.html'} and report.md: {len(document.sections)} sections, {seconds:.0f} s", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
