"""What a package must have beside its functions."""

import inspect
import pathlib

import pytest

import quadseg

FOLDER = pathlib.Path(quadseg.__file__).parent


def test_it_is_typed():
    assert (FOLDER / "py.typed").exists()
    stubs = (FOLDER / "_native.pyi").read_text()
    from quadseg import _native

    for name in dir(_native):
        if not name.startswith("_"):
            assert f"def {name}(" in stubs or f"{name}:" in stubs, f"_native.pyi lacks {name}"
    for name in ("segment", "inspect", "read", "write", "write_labels"):
        signature = inspect.signature(getattr(quadseg, name))
        assert signature.return_annotation is not inspect.Signature.empty
        assert all(p.annotation is not inspect.Parameter.empty for p in signature.parameters.values()), name


def test_everything_public_is_documented():
    for name in quadseg.__all__:
        thing = getattr(quadseg, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert inspect.getdoc(thing), f"{name} has no docstring"
    text = quadseg.segment.__doc__
    for parameter in inspect.signature(quadseg.segment).parameters:
        assert parameter in text, f"segment()'s docstring does not explain {parameter}"


def test_all_errors_are_of_one_family():
    for name in ("InputError", "OptionError", "FileError", "Cancelled", "OutOfMemory", "InternalError"):
        assert issubclass(getattr(quadseg, name), quadseg.Error)


def test_every_option_of_cpp_is_there():
    header = pathlib.Path(__file__).resolve().parents[2] / "engine/include/quadseg/options.h"
    if not header.exists():
        pytest.skip("no sources here")
    import re

    text = header.read_text()
    options = text[text.index("struct Options {") :]
    options = re.sub(r"//.*", "", options[: options.index("\n};")])
    names = set(re.findall(r"(\w+)\s*=[^;=]*;", options))
    assert {"preset", "tolerance", "coarse"} <= names
    assert names <= set(inspect.signature(quadseg.segment).parameters), "an option is missing in Python"


def test_version_is_that_of_the_library():
    assert quadseg.__version__.count(".") == 2
