"""The newest value of each key, of a limited number of keys: of senders, say, of whom anybody can make up more."""

from __future__ import annotations

from typing import TypeVar

Key = TypeVar("Key")
Value = TypeVar("Value")


class Newest(dict[Key, Value]):
    """Values in the order of their renewal."""

    def __init__(self, most: int) -> None:
        """`most`: keys that are kept."""
        super().__init__()
        self._most = most

    def renew(self, key: Key, value: Value) -> Value | None:
        """Set the value of a key, and return the former one; of too many keys the one silent for longest is dropped."""
        former = self.pop(key, None)
        self[key] = value
        if len(self) > self._most:
            del self[next(iter(self))]
        return former
