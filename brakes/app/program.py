"""The program ``brakes app``."""

from beamdyn.common.screens.screens import Program
from brakes.answers import STANDARD
from brakes.app.caliper import CALIPER, MECHANISM
from brakes.app.forklift import FORKLIFT
from brakes.app.screens import make_document

_STANDARD = (make_document(load()) for _, load in STANDARD.values())
BRAKES = Program("brakes", "Brakes", (FORKLIFT, *_STANDARD, CALIPER, MECHANISM))
