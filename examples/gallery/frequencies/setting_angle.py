"""
The direction decides: inward beams soften, outward beams stiffen
=================================================================

The same strip at five setting angles. Between inward (0 deg) and outward (180 deg) there is an angle at
which the first frequency starts out level.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
speeds = np.linspace(0, 50, 101)

fig, ax = plt.subplots()
for angle in (0, 45, 90, 135, 180):
    scene = bd.Scene(beam, bd.Mount(radius=0.215, setting_angle=np.radians(angle)))
    locus = bd.frequency_locus(scene, speeds, modes=1)
    ax.plot(speeds, locus.frequency[:, 0], label=f"{angle} deg")
ax.set(xlabel="speed [rad/s]", ylabel="first frequency [Hz]")
ax.legend(title="setting angle")

# %%
# The angle itself, from the change of the frequency with speed at rest:
limits = bd.setting_angle_limits(bd.Scene(beam, bd.Mount(radius=0.215)), top_speed=50.0)
print(f"{np.degrees(limits.first):.5f} deg")
