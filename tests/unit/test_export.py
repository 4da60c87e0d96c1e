"""Mode-shape files: read back with meshio, and refused where they should be."""

import meshio
import numpy as np
import pytest

from beamdyn.export import output_path, write_shapes

X = np.linspace(0, 0.05, 11)
SHAPES = np.stack([71.4 * (X / 0.05) ** 2, -30 * np.sin(60 * X)])
LABELS = ["mode 1: 65.23 Hz", "mode 2: 408.8 Hz"]


@pytest.fixture(params=[".vtu", ".vtk"])
def path(request, tmp_path):
    return tmp_path / f"shapes{request.param}"


def test_strip_is_read_back(path):
    write_shapes(path, X, SHAPES, LABELS, width=0.01)
    mesh = meshio.read(path)
    lower, upper = mesh.points.reshape(2, len(X), 3)
    zero = np.zeros_like(X)
    np.testing.assert_allclose(lower, np.stack([X, zero - 0.005, zero], axis=1), rtol=1e-15)
    np.testing.assert_allclose(upper, np.stack([X, zero + 0.005, zero], axis=1), rtol=1e-15)
    assert list(mesh.cells_dict) == ["quad"]
    assert area(mesh) == pytest.approx(0.05 * 0.01, rel=1e-12)


def test_modes_bend_along_z_by_a_tenth_of_the_length(path):
    write_shapes(path, X, SHAPES, LABELS, width=0.01)
    mesh = meshio.read(path)
    assert list(mesh.point_data) == names(path)
    for field, shape in zip(mesh.point_data.values(), SHAPES, strict=True):
        assert not field[:, :2].any()
        expected = shape / np.abs(shape).max() * 0.1 * 0.05
        np.testing.assert_allclose(field[:, 2].reshape(2, -1), [expected, expected], rtol=1e-14, atol=1e-18)


def test_no_width_is_a_line(path):
    write_shapes(path, X, SHAPES, LABELS, width=0)
    mesh = meshio.read(path)
    assert mesh.points.shape == (len(X), 3)
    np.testing.assert_array_equal(mesh.cells_dict["line"], [[i, i + 1] for i in range(10)])


def test_default_width_is_a_tenth_of_the_length(path):
    write_shapes(path, X, SHAPES, LABELS)
    assert np.ptp(meshio.read(path).points[:, 1]) == pytest.approx(0.005)


def test_width_may_vary(path):
    write_shapes(path, X, SHAPES, LABELS, width=0.01 - 0.1 * X)
    mesh = meshio.read(path)
    assert area(mesh) == pytest.approx(0.05 * (0.01 + 0.005) / 2, rel=1e-12)


def test_shape_of_zeros_stays(path):
    write_shapes(path, X, 0 * SHAPES, LABELS)
    assert not meshio.read(path).point_data[names(path)[0]].any()


def test_existing_file_is_kept_unless_forced(path):
    path.write_text("precious")
    with pytest.raises(FileExistsError, match=r"exists; .* force"):
        write_shapes(path, X, SHAPES, LABELS)
    assert path.read_text() == "precious"
    write_shapes(path, X, SHAPES, LABELS, force=True)
    assert list(meshio.read(path).point_data) == names(path)


def test_nothing_is_printed(path, capfd):
    write_shapes(path, X, SHAPES, LABELS)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["shapes.stl", "shapes", "shapes.vtu.txt"])
def test_unknown_suffix_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"unknown suffix .*\.vtu, \.vtk"):
        write_shapes(tmp_path / name, X, SHAPES, LABELS)
    assert not any(tmp_path.iterdir())


def test_suffix_may_be_in_capitals(tmp_path):
    write_shapes(tmp_path / "SHAPES.VTU", X, SHAPES, LABELS)
    assert list(meshio.read(tmp_path / "SHAPES.VTU", file_format="vtu").point_data) == LABELS


def test_missing_directory_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"no directory .*nowhere"):
        output_path(tmp_path / "nowhere" / "a.png", [".png"])


BAD = {
    "one position": ({"x": X[:1], "shapes": SHAPES[:, :1]}, "at least two"),
    "descending": ({"x": X[::-1]}, "ascend"),
    "too few labels": ({"labels": LABELS[:1]}, "1 labels times 11 positions"),
    "transposed": ({"shapes": SHAPES.T}, "2 labels times 11 positions"),
    "nan": ({"shapes": SHAPES * np.nan}, "real and finite"),
    "complex": ({"shapes": SHAPES * 1j}, "real part"),
    "labels alike": ({"labels": LABELS[:1] * 2}, "two are alike"),
    "negative width": ({"width": -0.01}, "0 or more"),
    "widths of another grid": ({"width": X[1:]}, "one for each of 11"),
}


@pytest.mark.parametrize(("change", "message"), BAD.values(), ids=BAD)
def test_bad_arrays_are_refused_and_nothing_is_written(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        write_shapes(tmp_path / "a.vtu", **{"x": X, "shapes": SHAPES, "labels": LABELS} | change)
    assert not any(tmp_path.iterdir())


def names(path):
    return LABELS if path.suffix == ".vtu" else [label.replace(" ", "_") for label in LABELS]


def area(mesh):
    """Signed area of a mesh of quadrilaterals in the plane z = 0."""
    a, b, c, d = mesh.points[mesh.cells_dict["quad"]].transpose(1, 0, 2)
    return np.cross(c - a, d - b)[:, 2].sum() / 2
