"""Turbines of the program OpenFAST: main file, and the files of ElastoDyn and BeamDyn named there."""

from __future__ import annotations

from dataclasses import replace

from beamdyn.common.edge.data_text import DataText, named_number, named_values, read_data
from beamdyn.files.decks import beamdyn_blade, elastodyn
from beamdyn.files.decks.blade import Blade, ignore
from beamdyn.files.decks.elastodyn import named_file

_ELASTODYN, _BEAMDYN = 1, 2  # values of the setting CompElast; 3 is a simplified ElastoDyn
_NO_TIP_MASS = "OpenFAST ignores this mass if BeamDyn computes the blades; to include it, give tip in [beam]"


def read_openfast_file(text: DataText) -> Blade:
    """Read the first blade of the turbine: from BeamDyn's file if BeamDyn computes it, else ElastoDyn's."""
    found = named_values(text, {"edfile", "compelast", "bdbldfile1"})
    model = named_number(text, found["compelast"]) if "compelast" in found else _ELASTODYN
    rotor = elastodyn.read_main_file(read_data(named_file(text, found["edfile"])))
    if model == _BEAMDYN and "bdbldfile1" in found:
        main = read_data(named_file(text, found["bdbldfile1"]))
        blade = beamdyn_blade.read_main_file(main, rotor.hub_radius)
        kept = {name: getattr(rotor, name) for name in ("pitch", "precone", "speed")}
        mass = rotor.tip.get("mass", 0.0)  # OpenFAST ignores this mass if BeamDyn computes the blades
        ignored = (*blade.ignored, *ignore("TipMass(1)", mass, "kg", _NO_TIP_MASS))
        return replace(blade, sources=(text.path, rotor.sources[0], *blade.sources), ignored=ignored, **kept)
    reason = "OpenFAST computes these blades by another module; this is the blade in ElastoDyn's files"
    ignored = (*ignore("CompElast", model if model != _ELASTODYN else 0.0, "", reason), *rotor.ignored)
    return replace(rotor, sources=(text.path, *rotor.sources), ignored=ignored)
