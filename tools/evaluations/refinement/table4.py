"""The paper's Table 4: the same sequences of waypoints with growing horizons, each compared with the one before."""

from __future__ import annotations

import argparse

from tailor.tools.evaluations.refinement import refinement

PRESET = refinement.Preset(
    "table4",
    "Table 4: effect of the horizon",
    {"soccer": ("waypoints",)},
    {"soccer": "each horizon over the one before: 10.6, 0.7, 0.2 %"},
)


check = refinement.check


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table4`."""
    refinement.configure(parser, horizons=(2, 3, 4))


def run(arguments: argparse.Namespace) -> int:
    """See `refinement.run`."""
    return refinement.run(arguments, PRESET)
