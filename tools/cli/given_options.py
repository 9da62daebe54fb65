"""Options that were given on a command line, so that those which mean nothing can be refused."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping


def given_options(
    configure: Callable[[argparse.ArgumentParser], None], arguments: argparse.Namespace, names: Mapping[str, str]
) -> list[str]:
    """Those of the options `names`, option -> name of its value, whose values are not an empty command line's.

    Args:
      configure: Adds the flags to a parser.
      arguments: What such a parser has parsed.
      names: Options to look at.
    """
    parser = argparse.ArgumentParser()
    configure(parser)
    defaults = parser.parse_args([])
    return [option for option, name in names.items() if getattr(arguments, name) != getattr(defaults, name)]
