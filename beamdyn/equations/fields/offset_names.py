"""Names of the terms and loads due to offsets of section centres, by the quantity that multiplies each."""

from __future__ import annotations

from collections.abc import Mapping

from beamdyn.equations import explanations as why
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.root_motion import Quantity

NAMES: dict[tuple[Quantity, int], str] = {
    ("unity", 2): "mass of offsets",
    ("speed", 1): "Coriolis coupling of offsets",
    ("acceleration", 0): "Euler coupling of offsets",
    ("speed_squared", 0): "rotation of offsets",
    ("root_axial", 0): "tension by root acceleration of offsets",
    ("root_transverse", 0): "root acceleration of offsets",
    ("root_across", 0): "root acceleration of offsets",
}
NAMES_OF_LOADS: dict[Quantity, str] = {
    "acceleration": "angular acceleration on offsets",
    "speed_squared": "rotation on offsets",
    "root_axial": "axial root acceleration on offsets",
    "root_transverse": "root acceleration on offsets",
    "root_across": "root acceleration on offsets",
}
_BESIDE = Condition(lambda s: s.scene.beam.has_offsets, "the centres of mass and tension are on the axis")
_ROTATES_ALONG = Condition(
    lambda s: bool(s.scene.mount.precone) or s.scene.physics.stretch,
    "no precone, and stretch is not modelled",
)
EXPLANATIONS: Mapping[str, Explanation] = {
    "mass of offsets": Explanation("m c (w'' + θ'')", "the centre of mass lies beside the axis", (_BESIDE,)),
    "Coriolis coupling of offsets": Explanation(
        "2 ω sin(η) m c (w' + θ')", "masses move beside the axis", (_BESIDE, why.TURNS, _ROTATES_ALONG)
    ),
    "Euler coupling of offsets": Explanation(
        "ω' x m c (u'^2 + θ^2)", "the speed varies", (_BESIDE, why.ACCELERATES)
    ),
    "rotation of offsets": Explanation(
        "ω² (NB t w'' + m x c w') θ", "rotation pulls at centres beside the axis", (_BESIDE, why.TURNS)
    ),
    "tension by root acceleration of offsets": Explanation(
        "-aO1 (NA t w'' + m c w') θ", why.say_tension, (_BESIDE, why.TENSIONED)
    ),
    "root acceleration of offsets": Explanation(
        "m c (aO2 + aO3) (u'^2 + θ^2)", why.say_static_load, (_BESIDE, why.LOADED)
    ),
    "angular acceleration on offsets": Explanation(
        "ω' m (c + x c θ)", "the speed varies", (_BESIDE, why.ACCELERATES)
    ),
    "rotation on offsets": Explanation(
        "ω² (m c + NB t u'')", "rotation pulls at centres beside the axis", (_BESIDE, why.TURNS)
    ),
    "axial root acceleration on offsets": Explanation(
        "-aO1 (m c u' + NA t u'')", why.say_tension, (_BESIDE, why.TENSIONED)
    ),
    "root acceleration on offsets": Explanation(
        "-(aO2 + aO3) m c θ", why.say_static_load, (_BESIDE, why.LOADED)
    ),
}
