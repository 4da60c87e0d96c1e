"""
One shoe pushes the other
=========================

Forces in a forklift's duo-servo brake over its torque. The piston (11.65 kN) pushes the trailing shoe;
the drum drags it along, and the adjuster passes three times that force (Q) on to the leading shoe, which
does most of the work.
"""

import matplotlib.pyplot as plt
import numpy as np

from brakes import forklift

torque = np.linspace(8000, 12000, 81)
forces = forklift.internal_forces(forklift.BENDIX_12_5, torque=torque, piston_force=11650.0, clearance=0.0106)

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for name, part in {
    "A": "A, normal force on the leading shoe",
    "P_L": "P_L, its piston",
    "B": "B, friction on it",
    "Q": "Q, the adjuster",
}.items():
    left.plot(torque / 1e3, getattr(forces, name) / 1e3, label=part)
left.set(xlabel="torque [kN m]", ylabel="force [kN]", ylim=(0, 180))
left.legend()
right.plot(torque / 1e3, 100 * forces.leading_share, label="leading shoe")
right.plot(torque / 1e3, 100 * forces.trailing_share, label="trailing shoe")
right.set(xlabel="torque [kN m]", ylabel="share of the torque [%]", ylim=(0, 100))
right.legend()
