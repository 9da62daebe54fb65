"""Writes measured figures into SAFETY.md: `make test-faults`, then `python -m tests.support.safety.renew FILE`."""

import json
import sys
from pathlib import Path

from tests.support.safety.page import PAGE, renewed


def main(path):
    """Returns the exit code: 1 and no change if a promise is broken."""
    results = json.loads(Path(path).read_text())
    broken = sorted({row["test"] for row in results if not row["passed"]})
    if broken:
        print("not renewed, these tests failed:", *broken, sep="\n", file=sys.stderr)
        return 1
    PAGE.write_text(renewed(PAGE.read_text(), results))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
