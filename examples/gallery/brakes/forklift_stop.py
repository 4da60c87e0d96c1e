"""
A loaded forklift reverses down a slope
=======================================

Stopping distance over speed on six slopes, with reaction and rise of the brake force. On the steepest it
does not stop at all: there is no number, and no line.
"""

import matplotlib.pyplot as plt
import numpy as np

from brakes import forklift

truck = forklift.Truck(5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89)
speed = np.linspace(5, 25, 81)

fig, ax = plt.subplots()
for slope in (0, 5, 10, 17.3, 22, 27):
    conditions = forklift.StopConditions(
        np.radians(slope), speed / 3.6, 0.7, reaction_time=0.5, rise_time=0.3
    )
    stop = forklift.stop(truck, conditions)
    label = f"{slope:g} deg" if stop.stops.any() else f"{slope:g} deg: does not stop"
    ax.plot(speed, stop.distance, label=label)
ax.set(xlabel="speed [km/h]", ylabel="stopping distance [m]")
ax.legend(title="slope")
