"""Which bus a command goes on: its flags, and the endpoint that they come to.

Commands that only need the bus load no executive for it: `tailor estop` must not wait for one.
"""

from __future__ import annotations

import argparse

from tailor.runtime.bus.zenoh_config import DEFAULT_ENDPOINT


def configure_bus(parser: argparse.ArgumentParser) -> None:
    """The flags of everyone who goes on the bus."""
    parser.add_argument("--connect", metavar="ENDPOINT", help=f"bus endpoint (default {DEFAULT_ENDPOINT})")
    parser.add_argument("--config", metavar="FILE", help="deployment file (TOML)")


def endpoint_of(arguments: argparse.Namespace) -> str:
    """The endpoint; a deployment file is read as a whole, so that a mistake anywhere in it is told.

    Raises:
      UsageError: What `tailor.tools.cli.deployment.deployment` raises.
    """
    if not arguments.config:
        return arguments.connect or DEFAULT_ENDPOINT
    from tailor.tools.cli.deployment import deployment

    return deployment(arguments).bus.endpoint
