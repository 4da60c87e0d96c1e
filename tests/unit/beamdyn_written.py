"""Files of BeamDyn and OpenFAST, written for the tests."""

import numpy as np

from tests.unit.decks_written import elastodyn_blade, elastodyn_main

STATIONS = (0.0, 0.5, 1.0)
POINTS = (
    (0, 0, 0, 12.0),
    (-0.05, 0.01, 10, 6.0),
    (-0.3, 0.1, 20, 2.0),
    (-0.9, 0.4, 30, 0.0),
)  # x, y, z [m] and twist [deg]
CENTRE, TENSION = (0.06, -0.11), (0.04, 0.09)  # x and y of the centres of mass and of tension [m]
MASS, INERTIA = 200.0, (40.0, 6.0)  # mass per length [kg/m]; inertias about x and y through the centre [kg m]
FLAP, EDGE, TORSION, AXIAL, SHEAR = 2e8, 8e8, 5e7, 5e9, (3e8, 9e8)


def stiffness(factor=1.0):
    """Return the stiffness in BeamDyn's order, about the axis, with the centre of tension beside it."""
    (x, y), K = TENSION, np.diag([*SHEAR, AXIAL, EDGE, FLAP, TORSION])
    strain = np.eye(6)
    strain[2, 3], strain[2, 4] = y, -x  # bending stretches the centre of tension
    return factor * strain.T @ K @ strain


def mass(factor=1.0):
    (x, y), M = CENTRE, np.diag([MASS, MASS, MASS, *INERTIA, sum(INERTIA)])
    velocity = np.eye(6)  # velocity of the centre from that of the axis and the turning rates
    velocity[0, 5], velocity[1, 5], velocity[2, 3], velocity[2, 4] = -y, x, y, -x
    return factor * velocity.T @ M @ velocity


def blade_file(of_stiffness=stiffness, of_mass=mass, count=3):
    lines = ["------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE ----", "A blade of the tests"]
    lines += ["-------- BLADE PARAMETERS ----", f"{count}  station_total - Number of stations (-)"]
    lines += [
        "1   damp_type - 0: no damping; 1: damped",
        "---- DAMPING COEFFICIENT ----",
        "mu1 mu2 mu3 mu4 mu5 mu6",
    ]
    lines += ["(-) (-) (-) (-) (-) (-)", "1e-3 1e-3 1e-3 2e-3 1e-3 1e-3", "---- DISTRIBUTED PROPERTIES ---"]
    for station, factor in zip(STATIONS, (1.0, 0.4, 0.1), strict=True):
        lines += [f" {station}"]
        for matrix in (of_stiffness(factor), of_mass(factor)):
            lines += [*(" ".join(f"{value:.12E}" for value in row) for row in matrix), ""]
    return "\n".join(lines) + "\n"


def primary_file(points=POINTS, members=("1 4",), **changes):
    given = {"member_total": len(members), "kp_total": len(points)} | changes
    lines = ["--------- BEAMDYN with OpenFAST INPUT FILE ---", "A blade of the tests", "---- GEOMETRY ----"]
    lines += [f" {value}   {name}  - what it is (-)" for name, value in given.items()]
    lines += [f" {member} - Member number; Number of key points in this member" for member in members]
    lines += ["  kp_xr  kp_yr  kp_zr  initial_twist", "  (m)  (m)  (m)  (deg)"]
    lines += [" ".join(f"{value:.8E}" for value in point) for point in points]
    return "\n".join(
        [*lines, "---- MATERIAL ----", '"blade.dat"  BldFile - Name of file (quoted string)', ""]
    )


def write_turbine(folder, **files):
    """Write the files of an OpenFAST turbine whose blades BeamDyn computes."""
    written = {"primary.dat": primary_file(), "blade.dat": blade_file(), "ed.dat": elastodyn_main()}
    written |= {
        "turbine.fst": '1 X\n2  CompElast - (switch)\n"ed.dat"  EDFile\n"primary.dat"  BDBldFile(1)\n'
    }
    written |= {name.replace("_", "."): text for name, text in files.items()}
    (folder / "sub").mkdir()
    (folder / "sub" / "blade.dat").write_text(elastodyn_blade())
    for name, text in written.items():
        (folder / name).write_text(text)
    return folder / "turbine.fst"
