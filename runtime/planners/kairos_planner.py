"""Prints a plan of kairos-planner for a PDDL problem: SECONDS TICK DOMAIN PROBLEM."""

from __future__ import annotations

import sys
from datetime import timedelta
from pathlib import Path
from typing import Any


def main(seconds: str, tick: str, domain: str, problem: str) -> int:
    """Plan and print; 0 with a plan, 1 without, with the reason as last line: the reader of plans quotes it.

    Args:
      seconds: Time for better plans; 0: the first plan, without a limit.
      tick: Least time between dependent events in seconds; 0: that of kairos-planner.
      domain: Path of the domain.
      problem: Path of the problem.
    """
    import kairos

    limit_s = float(seconds)
    options: dict[str, Any] = (
        {"anytime": True, "timeout": timedelta(seconds=limit_s)} if limit_s else {"anytime": False}
    )
    if float(tick):
        options["epsilon"] = float(tick)
    texts = (Path(path).read_text("utf-8") for path in (domain, problem))
    try:
        result = kairos.solve(*texts, threads=1, **options)
    except kairos.PddlError as error:  # a line for each fault
        print(str(error).partition("\n")[0])
        return 1
    print(result.plan.to_string() if result.plan is not None else result.status.name.lower().replace("_", " "))
    return 0 if result.plan is not None else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
