"""An object beside a run of an action, as an example to learn from."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.executive.interfaces.values import Array


@dataclass(frozen=True, slots=True)
class Beside:
    """An object beside a run.

    Attributes:
      tick: From which on the run is looked at.
      row: The object as it is believed there, shape (c,).
      failure: `ActionContext.failure` if the run from there on meets the object, else "".
    """

    tick: int
    row: Array
    failure: str
