"""
Where the force goes in an eeBrake
==================================

The caliper open (grey) and closed on the rim, with all its forces.
"""

import matplotlib.pyplot as plt

from beamdyn.common.drawing.on_axes import draw_on
from brakes import calipers
from brakes.drawings.caliper import caliper_drawing

caliper = calipers.EeBrake().build()
fig, ax = plt.subplots(figsize=(8, 8))
draw_on(ax, caliper_drawing(caliper, caliper.equilibrium(finger=40.0)))
