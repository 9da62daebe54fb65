"""pytest plug-in: `pytest --tailor-domain NAME` tests a domain against the contract, beside the repository's tests.

pytest loads it in every session of an environment that has Tailor; so it imports nothing until it is asked.
"""

from __future__ import annotations

from pathlib import Path

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare --tailor-domain."""
    parser.getgroup("tailor").addoption(
        "--tailor-domain",
        action="append",
        metavar="NAME",
        help="also test this installed domain against Tailor's contract; may be repeated",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Add the suite to the tests.

    Raises:
      pytest.UsageError: There is no such domain, or its package is at fault.
    """
    names = config.getoption("tailor_domain")
    if not names:
        return
    from tailor.schemas.errors import UsageError
    from tailor.schemas.installed import spec_of

    try:
        for name in names:
            spec_of(name)
    except UsageError as error:
        raise pytest.UsageError(f"--tailor-domain: {error}") from None
    suite = str(Path(__file__).with_name("suite.py"))
    if suite not in config.args:
        config.args.append(suite)
