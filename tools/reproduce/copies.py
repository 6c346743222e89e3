"""What the repository keeps of a report: its tables, and three small pictures for the README."""
import pathlib
import sys

import numpy as np

import png
from workshop import HERE, ROOT

LARGEST = 150_000  # bytes of a picture
PICTURES = ROOT / "datasets/pictures"

HEAD = """<!-- Written by tools/reproduce/run --copy; don't edit. -->

"""


def trimmed(image, margin=8):
    """Without the white around it."""
    ink = (image < 250).any(axis=2)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    if len(rows) == 0:
        return image
    top, left = max(rows[0] - margin, 0), max(columns[0] - margin, 0)
    return image[top:rows[-1] + margin + 1, left:columns[-1] + margin + 1]


def montage(pictures, path):
    """Pictures side by side at half their size, in as many colours as fit."""
    panels = [png.halved(trimmed(png.read(picture))) for picture in pictures]
    image = png.side_by_side([np.pad(p, ((6, 6), (6, 6), (0, 0)), constant_values=255) for p in panels])
    for levels in (64, 32, 16):
        png.write(path, png.posterised(image, levels))
        if pathlib.Path(path).stat().st_size < LARGEST:
            return
    raise ValueError(f"{path}: larger than {LARGEST} bytes")


def write_copies(document, kit):
    (HERE / "REPORT.md").write_text(HEAD + document.markdown(pictures=False))
    wanted = {
        "paper_crank": ["figure1_regions", "figure1_types"],
        # With or without features: errors are drawn of the better one.
        "paper_errors": [f"figure10_fandisk_{method}_errors" for method in ("hybrid_22_*", "quadric_l2_22_*", "default_22")],
        "paper_smoothing": ["figure9_default_regions", "figure9_default_5_regions"],
    }
    for name, patterns in wanted.items():
        found = [sorted((kit.out / "pictures").glob(f"{pattern}.png"))[:1] for pattern in patterns]
        if all(found):
            montage([picture for some in found for picture in some], PICTURES / f"{name}.png")
        else:
            print(f"{name}.png: not made, this report lacks its pictures", file=sys.stderr)
