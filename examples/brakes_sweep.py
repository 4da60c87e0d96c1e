"""A drum brake over friction and a forklift over its slope: where one locks and the other does not stop.

Writes brakes_sweep.png into the current directory.
"""

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.results.pictures import save_figure
from brakes import drum, forklift
from brakes.drawings.drum import factors
from brakes.drawings.forklift import distances

shoe = drum.Shoe(  # m; angles in rad from straight down, where the pin is
    drum_radius=0.138,
    face_width=0.05,
    lining=np.radians((30, 110)),
    pivot=(0.020, -0.110),
    force_arm=0.115,
)
truck = forklift.Truck(
    empty_mass=5950,
    empty_cg=(1.049, 0.359),
    load_mass=3500,
    load_cg=(-1.20, 0.450),
    front_wheel_radius=0.40,
    wheelbase=1.89,
)
speeds, slopes = np.linspace(5, 25, 81) / 3.6, np.radians([0, 10, 17.3, 20, 26])


def stops():
    """All slopes and speeds in one call, shape (5, 81)."""
    conditions = forklift.StopConditions(
        slope=slopes[:, None], speed=speeds, friction=0.7, reaction_time=0.5, rise_time=0.3
    )
    return forklift.stop(truck, conditions)


def draw():
    figure = Figure(figsize=(10.0, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    factors(left, drum.simplex(shoe), friction=0.35)
    distances(right, speeds, slopes, stops().distance)
    right.set_title("Forklift, friction 0.7", fontsize=11)
    return figure


def main():
    brake = drum.brake_torque(drum.simplex(shoe), friction=0.35, force=1000.0)
    print(f"{brake.torque:.5g} N m; C* {brake.c_star:.4g}; locks at friction {brake.locking_friction:.4g}")
    print(stops().message)
    save_figure(draw(), "brakes_sweep.png", force=True)


if __name__ == "__main__":
    main()
