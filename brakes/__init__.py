"""Statics of brake mechanisms."""

from beamdyn.common.results.shown_by import SHOWN_BY

SHOWN_BY["brakes"] = "brakes.views"
