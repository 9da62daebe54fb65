"""Orderings of nodes that take time: a simple temporal network with all-pairs bounds in whole units of a time grid.

`rows[b][a]` is the greatest t_b - t_a that the constraints allow. Kept minimal by an incremental shortest-path update
(Dechter, Meiri & Pearl 1991). An order between two nodes costs at least one tick (`tick` units, VHPOP's tolerance), so
that no two dependent events coincide.
"""

from __future__ import annotations

from typing import NamedTuple

from tailor.executive.planning.structures.orderings import FIRST, GOAL, INITIAL, HasDuration

UNBOUNDED = 10**24  # units; sums of two stay far above any real bound
_FAR = UNBOUNDED // 2  # as good as unbounded
Row = tuple[int, ...]
_FREE: Row = (UNBOUNDED, UNBOUNDED)  # bounds between a new step's start and end and unrelated nodes


class TemporalNetwork(NamedTuple):
    """Bounds between all nodes; the goal has no time of its own and stays unbounded.

    `first` is the node of the first step, after those of the timed literals.
    """

    rows: tuple[Row, ...]
    late: tuple[int, ...]
    tick: int = 1
    first: int = FIRST

    @classmethod
    def start(cls, timed: tuple[int, ...], tick: int = 1) -> TemporalNetwork:
        """Initial state at time 0, the goal, and nodes at fixed times."""
        times = [0, None, *timed]
        rows = tuple(
            tuple(0 if a == b else UNBOUNDED if s is None or t is None else t - s for a, s in enumerate(times))
            for b, t in enumerate(times)
        )
        return cls(rows, tuple(_late(row, node, tick) for node, row in enumerate(rows)), tick, len(times))

    @property
    def entries(self) -> int:
        """See `Orderings`."""
        return len(self.rows) ** 2

    def with_step(self, action: HasDuration, moment: int, before: int) -> TemporalNetwork | None:
        """See `Orderings`: the nodes of start and end, bounded by the duration."""
        start = len(self.rows)
        end = start + 1
        tick = self.tick
        longest = UNBOUNDED if action.longest is None else action.longest
        first = self.rows[INITIAL] + (-tick, -tick - action.shortest)
        unbounded = (UNBOUNDED,) * start
        own = [(*unbounded, 0, -action.shortest), (*unbounded, longest, 0)]
        if before != GOAL:
            via = self.rows[before] + _FREE
            node = start + moment
            if via[INITIAL] + first[node] < tick:
                return None
            first = _through(first, first[node] - tick, via)
            own = [_through(row, row[node] - tick, via) for row in own]
        late = list(self.late)
        late[INITIAL] |= 3 << start
        rows = [first, *[row + _FREE for row in self.rows[1:]], *own]
        # only the initial state comes before the step: all other bounds on it pass through the initial state
        for other, row in enumerate(rows):
            if other != INITIAL and row[INITIAL] < _FAR:
                rows[other] = _through(row, row[INITIAL], first)
                if other < start:
                    late[other] = _late(rows[other], other, tick)
        late += [_late(rows[start], start, tick), _late(rows[end], end, tick)]
        return TemporalNetwork(tuple(rows), tuple(late), tick, self.first)

    def ordered(self, a: int, b: int) -> TemporalNetwork | None:
        """See `Orderings`: t_a <= t_b - 1 tick."""
        if self.late[b] >> a & 1:
            return None
        if b == GOAL or self.rows[a][b] <= -self.tick:
            return self
        via, tick = self.rows[b], self.tick
        rows, late = list(self.rows), list(self.late)
        for node, row in enumerate(self.rows):
            reach = row[a] - tick
            if reach < row[b]:
                rows[node] = changed = _through(row, reach, via)
                late[node] = _late(changed, node, tick)
        return TemporalNetwork(tuple(rows), tuple(late), tick, self.first)

    def not_before(self, node: int) -> int:
        """See `Orderings`; a tick may be several units."""
        return self.late[node] if self.tick == 1 else _late(self.rows[node], node, 1)

    def earliest(self) -> tuple[float, ...]:
        """Earliest times in units; the goal's is the makespan: the last end of a step, whatever happens by itself."""
        times = [-bound for bound in self.rows[INITIAL]]
        times[GOAL] = max([0, *times[self.first :]])
        return tuple(times)

    def bounds(self) -> tuple[tuple[int | None, ...], ...]:
        """Rows and columns of VHPOP's print, without the goal: [i][j] is the greatest t_j - t_i, None if unbounded."""
        nodes = [node for node in range(len(self.rows)) if node != GOAL]
        return tuple(tuple(_bound(self.rows[j][i]) for j in nodes) for i in nodes)


def _through(row: Row, reach: int, via: Row) -> Row:
    """The row after relaxing it through another node: `reach` is the bound to that node, `via` that node's row."""
    return tuple([old if old <= reach + more else reach + more for old, more in zip(row, via, strict=True)])


def _bound(value: int) -> int | None:
    return value if value < _FAR else None


def _late(row: Row, node: int, tick: int) -> int:
    """The nodes that cannot be a tick or more before this one; the goal is after all."""
    if node == GOAL:
        return 1 << GOAL
    return sum([1 << other for other, bound in enumerate(row) if bound < tick and other != GOAL], 1 << GOAL)
