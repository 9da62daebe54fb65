"""Prints a plan of kairos-planner for a PDDL problem: SECONDS DOMAIN PROBLEM; its first plan, or the best in time."""

from __future__ import annotations

import sys
from datetime import timedelta
from pathlib import Path


def main(seconds: str, domain: str, problem: str) -> int:
    """Plan and print; 0 with a plan, 1 without.

    Args:
      seconds: Time for better plans; 0: the first plan, without a limit.
      domain: Path of the domain.
      problem: Path of the problem.
    """
    import kairos

    limit_s = float(seconds)
    options = {"anytime": True, "timeout": timedelta(seconds=limit_s)} if limit_s else {"anytime": False}
    result = kairos.solve(Path(domain).read_text(), Path(problem).read_text(), threads=1, **options)
    print(result.plan.to_string() if result.plan is not None else f"; {result.status}")
    return 0 if result.plan is not None else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
