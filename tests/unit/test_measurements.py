"""Files of measured frequencies: what is read, and what is refused with line and remedy."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd

LIST = """  *****  INDEX OF DATA SETS ON RESULTS FILE  *****
   SET   TIME/FREQ    LOAD STEP   SUBSTEP  CUMULATIVE
     1  65.230             1         1         1
     2 0.40879E+03         1         2         2
     3  61.963             2         1         3
     4  406.33             2         2         4
"""


@pytest.fixture
def read(tmp_path):
    def of_text(text, **options):
        file = tmp_path / "data.csv"
        file.write_text(text)
        return bd.read_measurements(file, **options)

    return of_text


def test_frequencies_over_speed_with_units_and_empty_cells(read):
    data = read(
        "speed [rpm]; flap 1 [Hz]; torsion 1 [kHz]; uncertainty [Hz]\n0; 62.1; ; 0.5\n600; 58; 0.66; 0.5\n"
    )
    np.testing.assert_allclose(data.speeds, [0, 20 * np.pi], rtol=1e-15)  # one product
    np.testing.assert_array_equal(data.frequency, [[62.1, np.nan], [58.0, 660.0]])
    assert data.labels == ("flap 1", "torsion 1")
    assert data.count == 3
    # Half of the last digit as written: 0.05 and 0.5 Hz, 0.005 kHz.
    np.testing.assert_allclose(data.rounding, [[0.05, 0], [0.5, 5.0]], rtol=1e-12)  # powers of ten
    np.testing.assert_allclose(data.allowance[:, 0], [1.05, 1.5], rtol=1e-12)


def test_uncertainties_of_single_columns(read):
    data = read("f1 [Hz], uncertainty 1 [Hz], f2 [Hz]\n62, 0.3, 389\n")
    np.testing.assert_array_equal(data.uncertainty, [[0.3, np.nan]])


def test_one_column_is_a_list_of_modes_at_rest(read):
    data = read("frequency [Hz]\n62.1\n389\n1090\n")
    assert data.frequency.shape == (1, 3)
    assert data.speeds.tolist() == [0.0]


def test_a_list_of_modes_of_ansys_has_a_speed_for_each_load_step(read):
    data = read(LIST, speeds=[0.0, 50.0])
    np.testing.assert_array_equal(data.frequency, [[65.23, 408.79], [61.963, 406.33]])
    np.testing.assert_allclose(data.rounding, [[5e-4, 5e-3], [5e-4, 5e-3]], rtol=1e-12)  # powers of ten


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("frequency 1\n62.1\n", r"line 1: expected a unit like \[Hz\] for frequency 1, found none"),
        ("frequency 1 [s]\n62.1\n", r"line 1: .* found \[s\]"),
        ("speed [rpm], frequency 1 [Hz]\n0, 62.1\n9e9, 60\n", "line 3: speed = 9e9 rpm"),
        ("speed [rpm], frequency 1 [Hz]\n0, 62.1\n, 60\n", "line 3: expected a number for speed"),
        ("speed [rpm], frequency 1 [Hz]\n0, -62.1\n", "line 2: frequency 1 = -62.1 Hz: it must be greater"),
        ("speed [rpm], amplitude [mm]\n0, 62.1\n", "line 1: unknown column 'amplitude'; known are speed"),
        ("speed [rpm], uncertainty [Hz]\n0, 1\n", "line 1: expected a column such as 'frequency 1"),
        ("f1 [Hz], f2 [Hz]\n62, 390\n60, 385\n", "line 1: expected a column 'speed"),
        (LIST, "expected a column 'speed .* or 2 speeds given with the file, found none"),
        (LIST.replace("65.230", "0.0000"), "line 3: expected a frequency above 0"),
    ],
)
def test_mistakes_are_refused_with_their_line(read, text, said):
    with pytest.raises(ValueError, match=said):
        read(text)


def test_shapes_at_other_points_are_refused():
    shapes = np.ones((1, 3))
    with pytest.raises(ValueError, match="1 modes at 2 positions"):
        bd.MeasuredFrequencies([62.0], positions=[0.0, 0.05], shapes=shapes)
    strip = bd.Scene(bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0))
    data = bd.MeasuredFrequencies([62.0], positions=[0.01, 0.03, 0.06], shapes=shapes)
    with pytest.raises(ValueError, match=r"positions = 0.06 m: .* from 0 to its length"):
        bd.compare(strip, data)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"frequency": [np.nan]}, "none that is finite"),
        ({"frequency": [62.0, 390.0], "speeds": [0.0, 1.0]}, "1 rows for 2 speeds"),
        ({"frequency": [62.0], "uncertainty": 0.0}, "uncertainty = 0 Hz: it must be above 0"),
        ({"frequency": [62.0], "labels": ["a", "b"]}, "2 for 1 columns"),
        ({"frequency": [62.0], "positions": [0.0]}, "give positions and shapes"),
        ({"frequency": "62"}, "table of numbers"),
    ],
)
def test_wrong_arguments_are_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        bd.MeasuredFrequencies(**arguments)
