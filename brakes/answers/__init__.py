"""What a command, a screen and an HTML report show of each type of brake; the pattern is `base.BrakeType`.

Types of brakes with no options of their own are listed in `BRAKES`: a command and a screen for each.
"""

BRAKES = {  # name of the module in brakes.answers, of the command, and what the command says it shows
    "drum": "Torque, forces, shoe factors and self-locking of a drum brake with pivoted shoes.",
}
