"""Files of shapes, series and animations: read back, and refused where they should be."""

import meshio
import numpy as np
import pytest
from PIL import Image

from beamdyn.common.plots.export import animate, write_series, write_shapes
from beamdyn.common.results.files import check_writable

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


def test_surfaces_over_the_width_are_read_back(path):
    """At the place of every point of the mesh stands the deflection there, and that across along -y."""
    eta = np.linspace(-1, 1, 5)
    surfaces = SHAPES[:, :, None] * (1 + 0.5 * eta) + 20 * X[:, None] * eta**2
    across = np.stack([10 * X, 500 * X])
    write_shapes(path, X, surfaces, LABELS, width=0.01, across=across)
    mesh = meshio.read(path)
    assert area(mesh) == pytest.approx(0.05 * 0.01, rel=1e-12) and len(mesh.cells_dict["quad"]) == 40
    assert np.unique(mesh.cells_dict["quad"]).tolist() == [*range(len(mesh.points))]
    at = np.searchsorted(X, mesh.points[:, 0] - 1e-6), np.searchsorted(eta, mesh.points[:, 1] / 0.005 - 1e-6)
    for field, surface, aside in zip(mesh.point_data.values(), surfaces, across, strict=True):
        scale = 0.1 * 0.05 / max(np.abs(surface).max(), np.abs(aside).max())
        expected = np.stack([0 * aside[at[0]], -scale * aside[at[0]], scale * surface[at]], axis=1)
        np.testing.assert_allclose(field, expected, rtol=1e-14, atol=1e-18)


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
    with pytest.raises(FileNotFoundError, match=r"no folder .*nowhere"):
        check_writable(tmp_path / "nowhere" / "a.png", [".png"])


BAD = {
    "one position": ({"x": X[:1], "shapes": SHAPES[:, :1]}, "at least two"),
    "descending": ({"x": X[::-1]}, "ascend"),
    "too few labels": ({"labels": LABELS[:1]}, "expected 1 x 11, labels by positions"),
    "transposed": ({"shapes": SHAPES.T}, "expected 2 x 11, labels by positions"),
    "nan": ({"shapes": SHAPES * np.nan}, "real and finite"),
    "complex": ({"shapes": SHAPES * 1j}, "real part"),
    "labels alike": ({"labels": LABELS[:1] * 2}, "two are equal"),
    "negative width": ({"width": -0.01}, "0 or more"),
    "widths of another grid": ({"width": X[1:]}, "one for each of 11"),
    "surface of a line": ({"shapes": np.ones((2, 11, 3)), "width": 0}, "a line has no deflections across"),
    "across of another grid": ({"across": SHAPES[:, 1:]}, "across has shape"),
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


# Motions ------------------------------------------------------------------------------------------

T = np.linspace(29.6, 29.7, 6)
MOTION = np.sin(60 * T)[:, None] * 1e-3 * (X / 0.05) ** 2


def test_series_is_read_back_in_true_size(tmp_path):
    path = tmp_path / "motion.xdmf"
    write_series(path, X, T, MOTION, width=0.01)
    reader = meshio.xdmf.TimeSeriesReader(path)
    points, cells = reader.read_points_cells()
    assert np.ptp(points, axis=0) == pytest.approx([0.05, 0.01, 0])
    assert len(cells[0].data) == len(X) - 1
    for k in range(reader.num_steps):
        time, fields, _ = reader.read_data(k)
        assert time == T[k]
        np.testing.assert_array_equal(fields["displacement"][:, 2].reshape(2, -1), [MOTION[k], MOTION[k]])
    assert reader.num_steps == len(T)


def test_series_of_a_surface_has_each_row_of_points(tmp_path):
    path, eta = tmp_path / "motion.xdmf", np.linspace(-1, 1, 3)
    write_series(path, X, T, MOTION[:, :, None] * (2 + eta), width=0.01)
    reader = meshio.xdmf.TimeSeriesReader(path)
    points, _ = reader.read_points_cells()
    _, fields, _ = reader.read_data(1)
    rows = points[:, 1].reshape(3, -1)[:, 0] / 0.005
    np.testing.assert_array_equal(rows, eta)
    np.testing.assert_array_equal(fields["displacement"][:, 2].reshape(3, -1), MOTION[1] * (2 + eta[:, None]))


def test_series_is_one_file(tmp_path):
    write_series(tmp_path / "motion.xdmf", X, T, MOTION)
    assert [p.name for p in tmp_path.iterdir()] == ["motion.xdmf"]


def test_animation_has_one_picture_a_time_that_moves(tmp_path):
    path = tmp_path / "motion.gif"
    animate(X, T, MOTION, path)
    with Image.open(path) as image:
        assert image.n_frames == len(T) and image.info["loop"] == 0
        pictures = []
        for k in range(len(T)):
            image.seek(k)
            pictures.append(image.convert("L").tobytes())
    assert len(set(pictures)) == len(T)


def test_beam_at_rest_is_animated(tmp_path):
    animate(X, T[:2], 0 * MOTION[:2], tmp_path / "rest.gif")


WRITERS = {
    ".xdmf": lambda path, *arrays, **options: write_series(path, *arrays, **options),
    ".gif": lambda path, *arrays, **options: animate(*arrays, path, **options),
}


@pytest.mark.parametrize("suffix", WRITERS)
def test_motion_that_exists_is_kept_unless_forced(tmp_path, suffix):
    path = tmp_path / f"motion{suffix}"
    path.write_text("precious")
    with pytest.raises(FileExistsError, match="force"):
        WRITERS[suffix](path, X, T[:2], MOTION[:2])
    assert path.read_text() == "precious"
    WRITERS[suffix](path, X, T[:2], MOTION[:2], force=True)
    assert path.read_bytes() != b"precious"


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(
    ("x", "t", "motion", "message"),
    [
        (X, T, MOTION.T, "expected 6 x 11, times by positions"),
        (X, T[::-1], MOTION, "ascend"),
        (X[::-1], T, MOTION, "ascend"),
        (X, T, MOTION * np.nan, "finite"),
    ],
)
def test_motions_that_do_not_fit_are_refused(tmp_path, suffix, x, t, motion, message):
    with pytest.raises(ValueError, match=message):
        WRITERS[suffix](tmp_path / f"motion{suffix}", x, t, motion)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", WRITERS)
def test_other_suffixes_are_refused(tmp_path, suffix):
    with pytest.raises(ValueError, match=f"unknown suffix '.x'; give one of {suffix}"):
        WRITERS[suffix](tmp_path / "motion.x", X, T, MOTION)
