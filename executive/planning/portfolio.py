"""Two engines by turns: the first proof or plan counts."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from typing import Protocol

from tailor.executive.planning.plans.plan import Result

SHORT_STEPS = 20  # partial-order search seldom solves problems with longer relaxed plans
SHORT_GOAL = 500  # conditions; the problems at hand have 20 at most
HEAD_START = 2000  # plans refined first where relaxed plans are short: what is found by then keeps its plan and counts
SHARE = 4  # plans refined per evaluated state, which takes ten times as long as a plan


def head_start(expected_steps: int, conditions: int) -> int:
    """The plans that partial-order search refines before the forward engine starts.

    Args:
      expected_steps: Steps of a relaxed plan.
      conditions: Literals of the goal: each takes a refinement, whose time grows with their number.
    """
    return HEAD_START if expected_steps <= SHORT_STEPS and conditions <= SHORT_GOAL else SHARE


class Engine(Protocol):
    """A search for a plan, with its counts so far."""

    @property
    def generated(self) -> int:
        """Number of plans or states generated."""
        ...

    @property
    def visited(self) -> int:
        """Number of plans refined, or states evaluated."""
        ...

    def run(self) -> Iterator[Result | None]:
        """Advances by one plan or state per iteration; yields None until the result."""
        ...


class Portfolio:
    """Runs both engines until one has a plan or a proof, or both have reached a limit; counts are sums."""

    def __init__(self, first: Engine, second: Engine, head_start: int, share: int = SHARE) -> None:
        """The first engine is advanced by `head_start` portions, then by `share` for each one of the second."""
        self._engines = (first, second)
        self._head_start = head_start
        self._share = share

    @property
    def generated(self) -> int:
        """See `Engine`."""
        return sum(engine.generated for engine in self._engines)

    @property
    def visited(self) -> int:
        """See `Engine`."""
        return sum(engine.visited for engine in self._engines)

    def run(self) -> Iterator[Result | None]:
        """See `Engine`."""
        first, second = (engine.run() for engine in self._engines)
        reasons: list[str] = []
        portions = [(first, self._head_start), (second, 1)]
        while portions:
            for work, portion in portions.copy():
                result = yield from _advanced(work, portion)
                if result is None:
                    continue
                if result.status in ("solved", "unsolvable"):
                    yield replace(result, generated=self.generated, visited=self.visited)
                    return
                reasons += [result.reason] if result.status == "limit" else []
                portions = [(other, n) for other, n in portions if other is not work]
            portions = [(work, self._share if work is first else 1) for work, _ in portions]
        yield Result("limit", None, "; ".join(dict.fromkeys(reasons)), self.generated, self.visited)


def _advanced(work: Iterator[Result | None], portion: int) -> Generator[None, None, Result | None]:
    """Advances an engine by so many plans or states; returns its result, if it has one by then."""
    for _ in range(portion):
        result = next(work)
        if result is not None:
            return result
        yield None
    return None
