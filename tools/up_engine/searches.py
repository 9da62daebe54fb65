"""Searches for plans of a translated problem that keep unified-planning's rules on time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from tailor.executive.planning import AnytimeSearch, Result, Settings
from tailor.tools.plan_search.limits import Limits
from tailor.tools.plan_search.sources import built_in
from tailor.tools.up_engine.translation import Translation

NOT_WHOLE = "no plan in whole numbers, as discrete time requires"


def once(task: Translation, settings: Settings, limits: Limits) -> Result:
    """The result of a search; of a second one without overlaps where the first plan has one, as these take longer."""
    result = built_in(task.domain, task.problem, settings, limits)
    if result.plan is not None and task.overlap(result.plan):
        task = task.without_overlap()
        result = built_in(task.domain, task.problem, settings, limits)
    return result if result.plan is None or task.is_whole(result.plan) else _not_whole(result)


@dataclass(slots=True)
class Improvement:
    """A search for ever better plans, which begins again without overlaps at the first plan that has one.

    Attributes:
      last: The result with the best plan so far, or why there is none.
      is_proven: Whether no plan is better.
    """

    task: Translation
    settings: Settings
    limits: Limits
    last: Result = field(default=Result("limit", None, "", 0, 0), init=False)
    is_proven: bool = field(default=False, init=False)

    def run(self) -> Iterator[Result]:
        """A result with each better plan."""
        best, search = math.inf, self._search()
        while not search.ended and not self.limits.reason:
            result = search.advance(self.limits)
            if result is None or result.plan is None:
                continue
            if self.task.overlap(result.plan):
                self.task = self.task.without_overlap()
                search = self._search()
            elif search.value < best and self.task.is_whole(result.plan):
                self.last, best = result, search.value
                yield result
        self.is_proven = search.ended == "proven"
        if self.last.plan is None:
            found = search.best or Result("limit", None, self.limits.reason, *search.counts)
            self.last = found if found.plan is None else _not_whole(found)

    def _search(self) -> AnytimeSearch:
        return AnytimeSearch(self.task.domain, self.task.problem, self.settings)


def _not_whole(result: Result) -> Result:
    return replace(result, status="limit", plan=None, reason=NOT_WHOLE)
