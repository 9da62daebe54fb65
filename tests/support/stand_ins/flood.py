"""A process that floods keys of the bus. Arguments: endpoint, role, then names of topics; `NAME:junk` for junk bytes.

It connects at the gateway like a process of another user would, with the password of the role.
"""

import sys
import time

from tailor.runtime.bus import zenoh_config
from tailor.runtime.bus.rights.credentials import Password
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.session import opened
from tailor.schemas.codec import encode
from tailor.schemas.own import example
from tailor.schemas.topics import TOPICS

MAX_PUTS = 2_000_000
MAX_S = 60.0


def main(endpoint, role, *words):
    password = Password(role, run_folder(endpoint).password(role))
    with opened(zenoh_config.client([endpoint], 10_000, password)) as session:
        outlets = [outlet(session, word) for word in words]
        ends_s = time.monotonic() + MAX_S
        for number in range(MAX_PUTS):
            publisher, payload = outlets[number % len(outlets)]
            publisher.publish_encoded(payload)
            if number % 100 == 0 and time.monotonic() > ends_s:
                break


def outlet(session, word):
    """Publisher and payload of zeros, e.g. an e-stop of False, or of junk."""
    name, _, junk = word.partition(":")
    return session.publisher(name, "agilo"), b"junk" if junk else encode(zeros(TOPICS[name].type))


def zeros(kind):
    """A message of zeros."""
    return kind(False) if kind.__name__ == "EStop" else example(kind)


if __name__ == "__main__":
    main(*sys.argv[1:])
