"""Files of other programs, written for the tests in the formats of ElastoDyn, FAST and BModes."""

import numpy as np

STATIONS = (0.0, 0.2, 0.5, 0.8, 1.0)
TWIST = (12.0, 11.0, 5.0, 1.5, 0.0)  # structural twist [deg], positive to feather
MASS = (400.0, 300.0, 180.0, 60.0, 12.0)  # mass per length [kg/m]
FLAP = (4e9, 1.5e9, 2e8, 1.5e7, 2e5)  # flap stiffness [N m2]
EDGE = (4.2e9, 2.5e9, 9e8, 1.4e8, 6e6)
HEADS = ("BlFract", "PitchAxis", "StrcTwst", "BMassDen", "FlpStff", "EdgStff")
UNITS = ("(-)", "(-)", "(deg)", "(kg/m)", "(Nm^2)", "(Nm^2)")
SHAPES = {"BldFl1Sh": (0.1, 1.6, -1.2, 0.8, -0.3), "BldFl2Sh": (-0.7, 2.0, -9.0, 16.0, -7.3)}
SHAPES |= {"BldEdgSh": (0.5, 1.4, -1.4, 0.7, -0.2)}
LENGTH, HUB = 40.0, 1.25


def rows():
    table = zip(STATIONS, [0.25] * 5, TWIST, MASS, FLAP, EDGE, strict=True)
    return [" ".join(f"{value:.6E}" for value in row) for row in table]


def elastodyn_blade(**changes):
    """Return the lines of a blade file; its table begins in line 17."""
    given = {"count": 5, "heads": HEADS, "units": UNITS, "rows": rows(), "mass_factor": 1.1} | changes
    lines = ["------- ELASTODYN V1.00.* INDIVIDUAL BLADE INPUT FILE ----", "A blade of the tests"]
    lines += [
        "--------- BLADE PARAMETERS -----",
        f"  {given['count']}   NBlInpSt    - Number of stations (-)",
    ]
    lines += [f"  0.5   {name} - damping (%)" for name in ("BldFlDmp(1)", "BldFlDmp(2)", "BldEdDmp(1)")]
    lines += ["--------- BLADE ADJUSTMENT FACTORS ---"]
    lines += [f"  1.0   {name} - tuner (-)" for name in ("FlStTunr(1)", "FlStTunr(2)")]
    lines += [f"  {given['mass_factor']}   AdjBlMs     - Factor (-)  !a comment"]
    lines += ["  1.0D+00   AdjFlSt     - Factor (-)", "\t0.5\tAdjEdSt - Factor (-)"]
    lines += ["--------- DISTRIBUTED BLADE PROPERTIES ----"]
    lines += [" ".join(given["heads"]), " ".join(given["units"]), *given["rows"]]
    lines += ["--------- BLADE MODE SHAPES ---"]
    for name, values in SHAPES.items():
        lines += [f" {c:.7E}  {name}({k}) - , coeff of x^{k}" for k, c in enumerate(values, 2)]
    return "\n".join(lines) + "\n"


def elastodyn_main(**changes):
    """Return the lines of a main file; the names of its values are those of the manual."""
    given = {
        "TipRad": LENGTH + HUB,
        "HubRad": HUB,
        "PreCone(1)": -2.5,
        "PreCone(2)": -2.5,
        "TipMass(1)": 30.0,
    }
    given |= {"RotSpeed": 18.0, "BlPitch(1)": 4.0, "BldFile(1)": '"sub\\blade.dat"', "NumBl": 3} | changes
    lines = ["------- ELASTODYN v1.03.* INPUT FILE ------", "A rotor of the tests", "--------- ROTOR ----"]
    return "\n".join([*lines, *(f" {value}   {name}  - what it is (unit)" for name, value in given.items())])


MULTIPLIERS = (
    "sec_mass",
    "flp_iner",
    "lag_iner",
    "flp_stff",
    "edge_stff",
    "tor_stff",
    "axial_stff",
    "cg_offst",
)


def bmodes_main(**changes):
    """Return the lines of a main file of BModes 3."""
    given = {"Echo": "true", "beam_type": 1, "rot_rpm:": 18.0, "rpm_mult:": 0.5, "radius:": "41.25"}
    given |= {
        "hub_rad:": "1.25D0",
        "precone:": 0.0,
        "bl_thp:": 0.0,
        "hub_conn:": 1,
        "modepr:": 20,
        "TabDelim": "t",
    }
    given |= {
        "tip_mass": 20.0,
        "cm_loc": 0.05,
        "cm_axial": 0.3,
        "ixx_tip": 4.0,
        "iyy_tip": 3.0,
        "izz_tip": 2.0,
    }
    given |= {"ixy_tip": 0.0, "izx_tip": 0.0, "iyz_tip": 0.0, "id_mat:": 1}
    given |= {"sec_props_file": "'sections.dat'"} | {f"{name}_mult:": 1.0 for name in MULTIPLIERS} | changes
    lines = ["======   BModes v3.00 Main Input File  ====", "A blade of the tests", ""]
    return "\n".join(
        [*lines, *(f"{value}  {name}  what it is [1: this; 2: that]" for name, value in given.items())]
    )


def bmodes_sections(**changes):
    """Return the lines of section properties; the table begins in line 6."""
    given = {"count": 5, "first": "sec_loc"} | changes
    names = (
        "str_tw tw_iner mass_den flp_iner edge_iner flp_stff edge_stff tor_stff axial_stff cg_offst sc_offst"
    )
    units = "(-) (deg) (deg) (kg/m) (kg-m) (kg-m) (Nm^2) (Nm^2) (Nm^2) (N) (m) (m) (m)"
    lines = ["Sections of the tests", f"{given['count']}   n_secs:   number of sections (-)", ""]
    lines += [f"{given['first']} {names} tc_offst", units]
    zero = np.zeros(5)
    columns = (STATIONS, TWIST, TWIST, MASS, np.multiply(MASS, 0.05), np.multiply(MASS, 0.4), FLAP, EDGE)
    columns += (np.multiply(FLAP, 0.1), np.multiply(MASS, 1e7), zero + 0.1, zero, zero)
    lines += ["  ".join(f"{v:.8E}".replace("E", "D") for v in row) for row in zip(*columns, strict=True)]
    return "\n".join([*lines, "", "**Note: of a tower, str_tw is set to zero", "  cg_offst is set to zero"])


CSV = """# in mixed units; a comment
r [ft]; mass [kg/m]; EI flap [MN m2]; EI edge (Nm^2); twist [deg]; chord [m]

4.1010498687664; 440; 4000; 2.1e9; -12; 3
30.3477690288714; 330; 1500; 1.25D9; -11; 4
69.7178477690289; 198; 200; 4.5E+08; -5; 2
109.0879265091864; 66; 15; 7e7; -1.5; 1
135.3346456692913; 13.2; 0.2; 3e6; 0; 0.5
"""
CSV_ROWS = CSV.splitlines()[3:]
