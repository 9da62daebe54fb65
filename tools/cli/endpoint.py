"""Flags that select the bus, and the endpoint that they give.

Loads no executive unless a deployment file is named: `tailor estop` must not wait for one.
"""

from __future__ import annotations

import argparse

from tailor.runtime.bus.zenoh_config import DEFAULT_ENDPOINT


def configure_bus(parser: argparse.ArgumentParser) -> None:
    """Flags of every command that connects to the bus."""
    parser.add_argument("--connect", metavar="ENDPOINT", help=f"bus endpoint (default {DEFAULT_ENDPOINT})")
    parser.add_argument("--config", metavar="FILE", default="", help="deployment file (TOML)")


def endpoint_of(arguments: argparse.Namespace) -> str:
    """Endpoint of the bus. The whole deployment file is checked, so that no mistake in it goes unnoticed.

    Raises:
      UsageError: See `tailor.tools.cli.deployment.read_deployment`.
    """
    endpoint: str = arguments.connect
    if not arguments.config:
        return endpoint or DEFAULT_ENDPOINT
    from tailor.tools.cli.deployment import read_deployment

    deployment = read_deployment(arguments.config)
    return endpoint or deployment.bus.endpoint
