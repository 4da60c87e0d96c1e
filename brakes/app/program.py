"""The program ``brakes app``."""

from importlib import import_module

from beamdyn.common.screens.screens import Program
from brakes.answers import STANDARD
from brakes.app.caliper import CALIPER, MECHANISM
from brakes.app.forklift import FORKLIFT
from brakes.app.screens import make_document

_STANDARD = (make_document(import_module(f"brakes.answers.{name}").BRAKE) for name in STANDARD)
BRAKES = Program("brakes", "Brakes", (FORKLIFT, *_STANDARD, CALIPER, MECHANISM))
