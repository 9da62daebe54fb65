"""Nodes of a plan that make each literal true: one bit mask of nodes per literal, built on first use."""

from __future__ import annotations

from tailor.executive.planning.ground.ground_action import GroundAction

Masks = list[int] | dict[int, int]  # bit mask of nodes by literal; read only
_NONE: dict[int, int] = {}
MAX_TABLE = 4096  # literals of a table that is copied whole


class _Sparse(dict[int, int]):
    """Masks by literal, 0 for those that are absent."""

    def __missing__(self, literal: int) -> int:
        return 0

    def copy(self) -> _Sparse:
        """Another one with the same masks."""
        return _Sparse(self)


def no_masks(literals: int) -> Masks:
    """The masks of a plan without steps: a table, or a sparse one for large tasks."""
    return [0] * literals if literals <= MAX_TABLE else _Sparse()


class StepEffects:
    """The effects of a plan's steps; plans with the same steps share one.

    Most plans are dropped before their masks are read, so a new step is only noted; `masks()` copies the table.
    """

    __slots__ = ("_masks", "base", "bits", "node", "upheld")

    def __init__(
        self,
        base: Masks,
        bits: dict[int, int] | None = None,
        node: int = 0,
        upheld: dict[int, int] = _NONE,
    ) -> None:
        """A base table and, on top of it, the bits of one more step whose first node is `node`.

        `upheld` are the masks of the nodes that make a literal true which their own conditions require.
        """
        self.base = base
        self.bits = bits
        self.node = node
        self.upheld = upheld
        self._masks = base if bits is None else None

    def with_step(self, action: GroundAction, node: int) -> StepEffects:
        """The table with one more step."""
        upheld = self.upheld
        if action.upheld:
            upheld = upheld.copy()
            for literal, bits in action.upheld.items():
                upheld[literal] = upheld.get(literal, 0) | bits << node
        return StepEffects(self.masks(), action.bits, node, upheld)

    def masks(self) -> Masks:
        """Bit mask of the nodes that make each literal true, by literal; read only."""
        if self._masks is None:
            assert self.bits is not None
            masks = self.base.copy()
            for literal, bits in self.bits.items():
                masks[literal] |= bits << self.node
            self.base, self.bits, self._masks = masks, None, masks
        return self._masks
