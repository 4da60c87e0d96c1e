"""Files of histories, loads, responses and shapes: what is read, and what is refused with line and remedy."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

import beamdyn as bd

HISTORY = "time [s], tip [mm], root moment [N m]\n0.1, 1.0, 0.2\n0.2, -1.5, -0.3\n"
FAST = """
Predictions were generated on 01-Jan-2026 at 12:00:00 using FAST (v8.16.00a-bjj).
linked with NWTC Subroutine Library (v2.11.00)

Description from the FAST input file: a test

Time\tWindVxi\tTipDxb1\tRootMyb1
(s)\t(m/s)\t(m)\t(kN-m)
0.0000\t1.200E+01\t1.000E-01\t2.500E+00
0.0125\t1.200E+01\t1.100E-01\t2.600E+00
"""
HARMONIC = """
 ***** ANSYS POST26 VARIABLE LISTING *****

    FREQ           2 UY            2 UY
                   UY_2
                   AMPLITUDE       PHASE
   10.000        0.237310E-01   -180.000
   20.000        0.250000E-01   -179.000

 ***** ANSYS POST26 VARIABLE LISTING *****

    FREQ           2 UY            2 UY
                   UY_2
                   AMPLITUDE       PHASE
   30.000        0.300000E-01   -178.000
"""
TRANSIENT = """
 ***** ANSYS POST26 VARIABLE LISTING *****

    TIME           2 UY            3 UX
                   UY_2            UX_3
  0.10000E-01   0.237310E-01     0.1
  0.20000E-01   0.250000E-01     0.2
"""
SHAPES = "position [mm], shape at 62.1 Hz, shape at 0.389 kHz\n10, 0.06, -0.3\n30, 0.46, -0.6\n50, 1.0, 1.0\n"


@pytest.fixture
def read(tmp_path):
    def of_text(text, name="data.csv", **options):
        file = tmp_path / name
        file.write_text(text)
        return bd.read_measurements(file, **options)

    return of_text


def test_a_history_has_its_columns_in_si_and_half_of_their_last_digits(read):
    data = read(HISTORY)
    assert isinstance(data, bd.MeasuredHistory)
    assert data.names == ("tip", "root moment")
    np.testing.assert_allclose(data.value, [[1e-3, 0.2], [-1.5e-3, -0.3]], rtol=1e-15)  # one product
    np.testing.assert_allclose(data.allowance, [[5e-5, 0.05]] * 2, rtol=1e-12)  # powers of ten
    data = read("time [s], tip [mm], tip uncertainty [mm]\n0, 1.00, 0.1\n1, 1.00, 0.2\n")
    np.testing.assert_allclose(data.allowance[:, 0], [0.205e-3, 0.405e-3], rtol=1e-12)  # sums of three


def test_output_of_fast_is_read_with_the_columns_that_are_named(read):
    data = read(FAST, "run.out", columns={"tip": "TipDxb1", "root moment": "RootMyb1"})
    np.testing.assert_allclose(data.time, [0.0, 0.0125], rtol=1e-15)  # as written
    np.testing.assert_allclose(data.value, [[0.1, 2500.0], [0.11, 2600.0]], rtol=1e-15)  # one product
    with pytest.raises(ValueError, match=r'line 7: expected a column such as tip, .*"tip = WindVxi"'):
        read(FAST, "run.out")


def test_plots_of_multibody_programs_have_titles_and_axes_before_their_heads(read):
    text = "Plot 1\nX:Time(s),Y:Disp_TM-Tip(mm)\n0.0,0.0\n0.1,1.0\n"
    data = read(text, columns={"tip": "Disp_TM-Tip"})
    np.testing.assert_allclose(data.value[:, 0], [0.0, 1e-3], rtol=1e-15)  # one product


def test_lists_of_variables_of_ansys(read):
    data = read(HARMONIC, columns={"tip by tip force [mm/N]": "UY_2"}, speeds=[50.0])
    assert isinstance(data, bd.MeasuredResponse)
    assert (data.output, data.input, data.speed) == ("tip", "tip force", 50.0)
    np.testing.assert_array_equal(data.frequency, [10.0, 20.0, 30.0])
    np.testing.assert_allclose(data.magnitude, [2.3731e-5, 2.5e-5, 3e-5], rtol=1e-15)  # one product
    np.testing.assert_allclose(np.degrees(data.phase), [-180, -179, -178], rtol=1e-15)  # two products
    data = read(TRANSIENT, columns={"tip [mm]": "UY_2"})
    np.testing.assert_allclose(data.value[:, 0], [2.3731e-5, 2.5e-5], rtol=1e-15)  # one product
    with pytest.raises(ValueError, match=r"line 2: expected amplitude and phase of one variable"):
        read(HARMONIC.replace("PHASE", "IMAGINARY"))


@pytest.mark.parametrize("unit", ["mm/(m/s2)", "mm per m/s^2", "(mm)/(m/s2)"])
def test_units_of_responses_are_those_of_output_and_input(read, unit):
    data = read(f"frequency [Hz], tip by bending [{unit}]\n10, 2.0\n20, 3.0\n")
    np.testing.assert_allclose(data.columns[:, 0], [2e-3, 3e-3], rtol=1e-15)  # one product
    assert data.phase is None


def test_a_response_over_angular_frequency_at_the_speed_in_its_file(read):
    data = read("speed [rpm], frequency [rad/s], tip by bending [mm/(m/s2)]\n30, 10, 2.0\n30, 20, 3.0\n")
    np.testing.assert_allclose(data.frequency, [5 / np.pi, 10 / np.pi], rtol=1e-15)  # one product
    np.testing.assert_allclose(data.speed, np.pi, rtol=1e-15)  # one product
    assert read("frequency [Hz], tip by bending [mm/(m/s2)]\n10, 2.0\n20, 3.0\n").speed is None


def test_peaks_over_speed_have_one_window(read):
    text = "speed [rad/s], from [s], to [s], largest tip [mm]\n40, 1, 2, 0.5\n55, 1, 2, 1.96\n"
    data = read(text)
    assert isinstance(data, bd.MeasuredPeaks)
    np.testing.assert_array_equal(data.window, [1.0, 2.0])
    np.testing.assert_allclose(data.value[:, 0], [0.5e-3, 1.96e-3], rtol=1e-15)  # one product
    with pytest.raises(ValueError, match="line 3: expected the window"):
        read(text.replace("55, 1", "55, 0"))
    with pytest.raises(ValueError, match="line 2: expected a window"):
        read(text.replace(" 1, 2", " 2, 2"))


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("10, 1\n10, 2\n", "line 3: frequency = 10 Hz follows"),
        ("10, 1\n20, -2\n", "line 3: .* the phase"),
    ],
)
def test_a_response_that_cannot_be_is_refused_at_its_line(read, rows, said):
    with pytest.raises(ValueError, match=said):
        read(f"frequency [Hz], tip by bending [mm/(m/s2)]\n{rows}")


def test_shapes_are_read_with_their_frequencies_and_paired(read):
    data = read(SHAPES)
    np.testing.assert_allclose(data.frequency, [[62.1, 389.0]], rtol=1e-15)  # one product
    np.testing.assert_allclose(data.rounding, [[0.05, 0.5]], rtol=1e-12)  # powers of ten
    scene = bd.load_scene("examples/tyre_harvester.toml")
    found = bd.compare(scene, data)
    assert found.mode.tolist() == [1, 2]
    assert (found.likeness > 0.98).all()


def test_a_universal_file_has_a_response(tmp_path):
    pyuff = pytest.importorskip("pyuff", reason="needs the extra uff")
    file, f = tmp_path / "tip.uff", np.linspace(10.0, 100.0, 10)
    values = 1e-5 * np.exp(1j * np.linspace(0.0, 3.0, 10))
    made = pyuff.prepare_58(
        binary=0, func_type=4, rsp_node=1, rsp_dir=2, ref_node=1, ref_dir=2, data=values, x=f,
        ordinate_spec_data_type=8, orddenom_spec_data_type=13, abscissa_spec_data_type=18,
        id1="tip", rsp_ent_name="NONE", ref_ent_name="NONE", abscissa_spacing=1,
    )  # fmt: skip
    pyuff.UFF(str(file)).write_sets([made], "overwrite")
    data = bd.read_measurements(file)
    assert (data.output, data.input) == ("tip", "tip force")
    np.testing.assert_allclose(data.columns[:, 0], values, rtol=1e-5)  # five digits are written


@pytest.mark.skipif(find_spec("pyuff") is not None, reason="pyuff is installed")
def test_a_universal_file_without_its_package_says_what_to_install(read):
    with pytest.raises(ValueError, match=r"pip install 'beamdyn\[uff\]'"):
        read("    -1\n    58\n", "tip.uff")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time [s], tip\n0, 1\n1, 2\n", r"line 1: expected a unit like \[mm\] for tip, found none"),
        ("time, tip [mm]\n0, 1\n1, 2\n", r"line 1: expected a unit like \[s\] for time, found none"),
        ("time [s], tip [mm]\n0, 1\n1, 2\n1, 3\n", r"line 4: time = 1 s follows 1 s"),
        ("time [s], tip [mm]\n0, 1\n1, x\n", r"line 3: expected a number for tip \[mm\], found 'x'"),
        ("position [m], moment [N]\n0, 1\n1, 2\n", r"line 1: .*\[N m\] for moment, found \[N\]"),
        ("position [m], moment [N m]\n1, 1\n0, 2\n", r"line 3: .*positions that ascend"),
        ("position [m], shape 1\n0, 1\n1, 2\n", r"line 1: expected headings such as 'shape at 62.1 Hz'"),
        ("position [m], shape at 3 mm\n0, 1\n1, 2\n", r"line 1: shape at 3 mm"),
        ("frequency [Hz], tip by force [m/N]\n1, 1\n2, 2\n", r"line 1: expected a heading .*input = 'force'"),
        ("frequency [Hz], tip by tip force [mm]\n1, 1\n2, 2\n", r"line 1: .*\[m per N\].*found \[mm\]"),
    ],
)
def test_mistakes_are_refused_with_their_line(read, text, said):
    with pytest.raises(ValueError, match=said):
        read(text)


def test_one_speed_and_known_columns_are_asked_for(read):
    with pytest.raises(ValueError, match=r"speeds = .*at one speed"):
        read(SHAPES, speeds=[0.0, 1.0])
    with pytest.raises(ValueError, match="speeds = 1 rad/s: measured histories need no speed"):
        read(HISTORY, speeds=[1.0])
    peaks = "speed [rad/s], from [s], to [s], largest tip [mm]\n40, 1, 2, 0.5\n55, 1, 2, 1.96\n"
    with pytest.raises(ValueError, match=r"speeds = 31\.4 rad/s: the file has speeds of its own; leave"):
        read(peaks, speeds=[31.4])
    with pytest.raises(ValueError, match="line 1: there is no column 'Tip2'; the headings are time"):
        read(HISTORY, columns={"tip": "Tip2"})


def test_more_shapes_than_are_read_are_refused_by_their_line(read):
    heads = ", ".join(f"shape at {k} Hz" for k in range(1, 46))
    rows = "\n".join(", ".join([x, *["1"] * 45]) for x in ("10", "20"))
    with pytest.raises(bd.ConfigError, match=r"line 1: expected at most 40 shapes, found 45"):
        read(f"position [mm], {heads}\n{rows}\n")


@pytest.mark.parametrize(("unit", "size"), [("1e-6/N", 1e-6), ("-/N", 1.0), ("1/kN", 1e-3)])
def test_strain_by_a_force_has_a_plain_number_as_its_unit(read, unit, size):
    data = read(f"frequency [Hz], root strain by tip force [{unit}]\n10, 3\n20, 4\n")
    np.testing.assert_allclose(data.magnitude, [3 * size, 4 * size], rtol=1e-12)  # one product


def test_a_name_that_stands_twice_is_refused():
    with pytest.raises(ValueError, match=r"names = \('tip', 'tip'\): one stands twice"):
        bd.MeasuredHistory([0.0, 0.1], [[1.0, 2.0], [3.0, 4.0]], ["tip", "tip"])
