"""The paper's Table 3: greedy against refined from equal starts; `--profile degraded` stands in for the real robot."""

from __future__ import annotations

import argparse

from tailor.executive.domains.arm.letters import scenarios as letters
from tailor.tools.evaluations.refinement import refinement

PRESET = refinement.Preset(
    "table3",
    "Table 3: subgoal refinement",
    {"soccer": ("approach-dribble",), "arm": letters()},
    {
        "soccer": "9.8 s, 9.1 s, 6.6 %; the real robot: 10.6 s, 9.9 s, 6.1 %, n = 100",
        "arm": "10.6 s, 10.0 s, 5.7 %, p = 0.08, 4 letters",
    },
)
DOMAINS = tuple(PRESET.scenarios or ())


check = refinement.check


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table3`."""
    refinement.configure(parser, episodes=500)


def run(arguments: argparse.Namespace) -> int:
    """See `refinement.run`."""
    return refinement.run(arguments, PRESET)
