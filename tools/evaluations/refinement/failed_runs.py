"""Why runs failed: a table counts them, and whoever has to mend a robot needs their reasons and a start to repeat."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from tailor.tools.evaluations.refinement.paired_outcomes import Pair, Start

SHOWN = 3  # most frequent results of each side


def failure_remarks(pairs: Mapping[Start, Pair]) -> Iterator[str]:
    """One line for greedy and one for refined runs, where some did not achieve the goal."""
    for side, name in enumerate(("greedy", "refined")):
        starts: dict[str, list[Start]] = defaultdict(list)
        for start, pair in pairs.items():
            if not pair[side].achieved:
                starts[pair[side].result].append(start)
        if not starts:
            continue
        ordered = sorted(starts.items(), key=lambda each: (-len(each[1]), each[0]))
        shown = [
            f"{len(found)} × {result} (such as {found[0][0]}, seed {found[0][1]})" for result, found in ordered[:SHOWN]
        ]
        more = [f"{len(ordered) - SHOWN} other results"] if len(ordered) > SHOWN else []
        yield f"{name} runs that failed: {'; '.join([*shown, *more])}"
