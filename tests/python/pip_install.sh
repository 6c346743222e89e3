#!/bin/sh
# pip_install.sh PYTHON SOURCE FOLDER: installs the package from a copy of the source tree, and uses it.
set -eu
python=$1 source=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/source"
# pip leaves build folders in the tree it builds: not in the user's.
for part in CMakeLists.txt README.md LICENSE engine simplify datasets tools; do
    cp -r "$source/$part" "$folder/source/"
done
"$python" -m pip install --quiet --no-build-isolation --no-deps --no-index --disable-pip-version-check \
    --root-user-action=ignore --target "$folder/site" "$folder/source/tools/python"
cd "$folder"
PYTHONPATH="$folder/site" "$python" - <<'PYTHON'
import numpy as np, quadseg
assert "/site/" in quadseg.__file__, quadseg.__file__
vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.uint32)
result = quadseg.segment(vertices, faces, regions=4)
assert [region.type for region in result.regions] == ["plane"] * 4, result.regions
print("quadseg", quadseg.__version__, "installed by pip works")
PYTHON
