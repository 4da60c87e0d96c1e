"""The forklift's three screens: vehicle, kinematics, internal forces, each handing on to the next."""

from brakes.answers.forklift import FORKLIFT as BRAKE
from brakes.answers.forklift import STAGES
from brakes.app.screens import make_document, make_screen

VEHICLE, KINEMATICS, FORCES = (make_screen(stage) for stage in STAGES.values())
FORKLIFT = make_document(BRAKE, (VEHICLE, KINEMATICS, FORCES))
