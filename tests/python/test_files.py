"""Reading, writing, checking; arrays of other packages."""

import numpy as np
import pytest

import quadseg


@pytest.mark.parametrize("extension", ["ply", "off", "obj", "stl"])
def test_files_keep_the_order_of_faces(can, tmp_path, extension):
    vertices, faces = can
    path = tmp_path / f"can.{extension}"
    quadseg.write(path, vertices, faces)
    mesh = quadseg.read(path)
    assert mesh.vertices.dtype == np.float64 and mesh.faces.dtype == np.uint32 and mesh.polygons is None
    assert mesh.file_faces == len(faces)
    assert np.allclose(mesh.vertices[mesh.faces], vertices[faces], atol=1e-6)
    assert mesh.welded_vertices == (3 * len(faces) - len(vertices) if extension == "stl" else 0)


def test_labels_and_colors_are_written(can, tmp_path):
    vertices, faces = can
    labels = np.arange(len(faces)) % 7
    quadseg.write(tmp_path / "c.ply", vertices, faces, labels=labels, colors=np.zeros((len(faces), 3), np.uint8))
    header = (tmp_path / "c.ply").read_bytes()[:600]
    assert b"property int label" in header and b"property uchar red" in header
    quadseg.write_labels(tmp_path / "labels.txt", labels)
    assert np.array_equal(np.loadtxt(tmp_path / "labels.txt", dtype=int), labels)
    with pytest.raises(quadseg.OptionError, match="ply"):
        quadseg.write(tmp_path / "c.off", vertices, faces, labels=labels)
    with pytest.raises(quadseg.OptionError, match="labels"):
        quadseg.write(tmp_path / "c.ply", vertices, faces, labels=labels[1:])
    with pytest.raises(quadseg.OptionError, match="labels"):
        quadseg.write_labels(tmp_path / "labels.txt", labels.reshape(1, -1))


def test_polygons_come_along(tmp_path):
    path = tmp_path / "cube.off"
    path.write_text(
        "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
    )
    mesh = quadseg.read(path)
    assert len(mesh.faces) == 12 and mesh.file_faces == 6
    assert mesh.polygons.tolist() == [k // 2 for k in range(12)]
    result = quadseg.segment(mesh.vertices, mesh.faces, polygons=mesh.polygons)
    assert [region.type for region in result.regions] == ["plane"] * 6
    quadseg.write_labels(tmp_path / "labels.txt", result.labels, polygons=mesh.polygons)
    assert len((tmp_path / "labels.txt").read_text().split()) == 6


def test_file_errors(can, tmp_path):
    with pytest.raises(quadseg.FileError) as caught:
        quadseg.read(tmp_path / "none.ply")
    assert caught.value.code == "file_open" and isinstance(caught.value, OSError)
    (tmp_path / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n")
    with pytest.raises(quadseg.FileError, match="line 4") as caught:
        quadseg.read(tmp_path / "bad.off")
    assert caught.value.code == "file_format"
    with pytest.raises(quadseg.FileError) as caught:
        quadseg.write(tmp_path / "no folder" / "c.ply", *can)
    assert caught.value.code == "file_write"


def test_names_of_any_bytes(can, tmp_path):
    for name in ("Teil äöü.ply", b"latin-\xe4.ply".decode("utf-8", "surrogateescape")):
        quadseg.write(tmp_path / name, *can)
        assert len(quadseg.read(tmp_path / name).faces) == len(can[1])


def test_reading_can_be_stopped(can, tmp_path):
    quadseg.write(tmp_path / "can.ply", *can)
    with pytest.raises(quadseg.Cancelled):
        quadseg.read(tmp_path / "can.ply", timeout=1e-9)
    with pytest.raises(quadseg.OutOfMemory):
        quadseg.read(tmp_path / "can.ply", memory_limit=1000)


def test_inspect(can):
    report = quadseg.inspect(*can)
    assert report.faces == len(can[1]) and report.vertices == len(can[0])
    assert report.border_edges == 0 and report.components == 1
    assert report.feature_edges == 2 * 48
    assert report.area == pytest.approx(8 * np.pi, rel=0.01)
    assert report.box_min == pytest.approx((-1, -1, 0)) and report.box_max == pytest.approx((1, 1, 3))


def test_arrays_of_meshio(can, tmp_path):
    meshio = pytest.importorskip("meshio")
    quadseg.write(tmp_path / "can.obj", *can)
    mesh = meshio.read(tmp_path / "can.obj")
    result = quadseg.segment(mesh.points, mesh.cells_dict["triangle"])
    assert np.array_equal(result.labels, quadseg.segment(*can).labels)
    # And the labels go back: one number a cell, in the order of meshio's cells.
    mesh.cell_data["label"] = [result.labels]
    mesh.write(tmp_path / "labelled.vtk")
    back = meshio.read(tmp_path / "labelled.vtk")
    assert np.array_equal(back.cell_data["label"][0], result.labels)


def test_arrays_of_trimesh(can):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*can, process=False)
    assert len(quadseg.segment(mesh.vertices, mesh.faces).labels) == len(mesh.faces)


def test_arrays_of_open3d(can):
    open3d = pytest.importorskip("open3d")
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(can[0]), open3d.utility.Vector3iVector(can[1].astype(np.int32))
    )
    result = quadseg.segment(np.asarray(mesh.vertices), np.asarray(mesh.triangles))
    assert np.array_equal(result.labels, quadseg.segment(*can).labels)
