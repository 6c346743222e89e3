"""pip builds the compiled part of the Python package by CMake, for the interpreter that runs pip.

QUADSEG_CMAKE_ARGS: further arguments for CMake, for example -DQUADSEG_ARCH=native; the default is a portable build.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]


def version() -> str:
    match = re.search(r"project\(quadseg VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert match, "CMakeLists.txt names no version"
    return match[1]


class CMakeBuild(build_ext):
    def build_extension(self, extension: Extension) -> None:
        build = Path(self.build_temp).resolve() / "cmake"
        print(f"quadseg: building for {sys.executable} (Python {sys.version.split()[0]})", flush=True)
        configure = [
            "cmake", "-S", str(ROOT), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release", "-DQUADSEG_ARCH=",
            "-DQUADSEG_BUILD_PYTHON=ON", "-DQUADSEG_BUILD_TOOLS=OFF", "-DQUADSEG_BUILD_TESTS=OFF",
            "-DQUADSEG_INSTALL=OFF", f"-DPython3_EXECUTABLE={sys.executable}",
        ]  # fmt: skip
        if shutil.which("ninja"):
            configure += ["-G", "Ninja"]
        configure += shlex.split(os.environ.get("QUADSEG_CMAKE_ARGS", ""))
        subprocess.run(configure, check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", str(build), "--target", "quadseg_python", "-j", jobs], check=True)
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        (built,) = (build / "python" / "quadseg").glob("_native*.so")
        shutil.copy2(built, target)


setup(version=version(), ext_modules=[Extension("quadseg._native", sources=[])], cmdclass={"build_ext": CMakeBuild})
