"""Parses the words of a command; an error is one line, like all other errors, with what was probably meant."""

from __future__ import annotations

import argparse
import itertools
import re
from collections.abc import Iterable, Sequence
from typing import NoReturn

from tailor.schemas.errors import UsageError

LEAST = {"?": 0, "*": 0, "+": 1}  # words that a flag needs, by its number of them: further ones may be meant otherwise


class CommandParser(argparse.ArgumentParser):
    """A parser of one command, which reports an error without the usage."""

    _words: Sequence[str] = ()

    def parsed(self, words: Sequence[str]) -> argparse.Namespace:
        """What the words mean.

        Raises:
          UsageError: They are not those of the command.
        """
        self._words = words
        parsed, left = self.parse_known_args(words)
        if left and not any(word.startswith("-") for word in left):  # names that flags separate from the first ones
            return self.parse_intermixed_args(words)
        return self.parse_args(words) if left else parsed

    def error(self, message: str) -> NoReturn:
        """Raise UsageError with the message of argparse, and a hint."""
        unknown = re.match(r"unrecognized arguments: (--[^\s=]+)", message)
        hint = nearest(unknown[1], self._option_string_actions) if unknown else ""
        if message.startswith("the following arguments are required"):
            hint = self._taken_in()
        raise UsageError(f"{message}{hint} (see {self.prog} --help)")

    def _taken_in(self) -> str:
        """A hint at the flag that has taken in the word in the place of a required one; empty if none has."""
        for place, flag in enumerate(self._words):
            action = self._option_string_actions.get(flag)
            taken = [*itertools.takewhile(lambda word: not word.startswith("-"), self._words[place + 1 :])]
            if action is not None and len(taken) > LEAST.get(str(action.nargs), len(taken)):
                return f"; '{taken[-1]}' was taken as a value of {flag}, expected it before {flag}"
        return ""


def nearest(word: str, known: Iterable[str]) -> str:
    """A question about the known word that was probably meant; empty if none is like it. Dashes make none alike."""
    import difflib  # of no use to a command that is right

    bare = {each.lstrip("-"): each for each in known}
    near = difflib.get_close_matches(word.lstrip("-"), list(bare), n=1)
    return f", did you mean {bare[near[0]]}?" if near else ""
