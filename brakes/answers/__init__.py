"""What a command, a screen and an HTML report show of each type of brake; the pattern is `base.BrakeType`.

Types of brakes with no options of their own are listed in `STANDARD`: a command and a screen for each.
"""

STANDARD = {  # name of the module and of the command; what the command shows
    "drum": "Torque, forces, shoe factors and self-locking of a drum brake with pivoted shoes.",
}
