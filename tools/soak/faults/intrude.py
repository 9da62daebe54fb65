"""A process that speaks on a bus without leave: `python -m ... ENDPOINT ROBOT KIND SEED KNOWN`.

Prints one JSON object: whether its session was refused, and how much it sent in a few seconds.
"""

from __future__ import annotations

import json
import random
import sys

from tailor.schemas.errors import UsageError
from tailor.tools.soak.faults.intruder import Intruder
from tailor.tools.soak.faults.intrusions import KINDS
from tailor.tools.soak.systems.sessions import open_intruder
from tailor.tools.soak.systems.strangers import stranger_id


def main(endpoint: str, robot: str, kind: str, seed: str, known: str) -> None:
    """Intrude, and print what came of it; `known`: "observer", or "" for a stranger."""
    try:
        with open_intruder(endpoint, stranger_id(1)) as session:
            intruder = Intruder(session, robot, random.Random(int(seed)), bool(known))
            intruder.overhear()
            print(json.dumps({"refused": False, "sent": KINDS[kind](intruder)}))
    except UsageError:
        print(json.dumps({"refused": True, "sent": 0}))


if __name__ == "__main__":
    main(*sys.argv[1:])
