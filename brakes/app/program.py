"""The program ``brakes app``."""

from beamdyn.common.app.screens import Program
from brakes.app.caliper import CALIPER
from brakes.app.drum import DRUM
from brakes.app.forklift import FORKLIFT
from brakes.app.mechanism import MECHANISM

BRAKES = Program("brakes", "Brakes", (FORKLIFT, DRUM, CALIPER, MECHANISM))
