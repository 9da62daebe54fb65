"""rosbags' store of ROS 2 types, made to define and compile only what a robot's processes use: each waits for it.

rosbags compiles thirteen functions for a type, of CDR and of ROS 1 in both byte orders, where three serve; and it
defines 195 types of ROS 2 where 30 do. That takes 0.4 s of CPU time in each process.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import make_dataclass
from functools import cached_property
from typing import Any

from rosbags.serde.cdr import generate_deserialize_cdr, generate_getsize_cdr, generate_serialize_cdr
from rosbags.typesys.base import normalize_fieldname
from rosbags.typesys.store import Typestore

from tailor.schemas.ros_types.plain_definitions import Definition, parts


class CdrDefinition:
    """Functions between the values of one type and CDR, each compiled when it is first used.

    They have the names of rosbags' `Msgdef`, by which the code that rosbags compiles calls those of other types.
    """

    def __init__(self, store: CdrStore, name: str) -> None:
        self._store = store
        self.fields = [(normalize_fieldname(field), kind) for field, kind in store.fielddefs[name][1]]
        self.cls = store.types[name]

    @cached_property
    def _getsize(self) -> Any:
        return generate_getsize_cdr(self.fields, self._store)

    @cached_property
    def getsize_cdr(self) -> Any:
        """Computes the size of a value, bytes."""
        return self._getsize[0]

    @cached_property
    def size_cdr(self) -> int:
        """The size where all values have the same, bytes; otherwise 0."""
        return int(self._getsize[1])

    @cached_property
    def serialize_cdr_le(self) -> Any:
        """Writes a value, little-endian."""
        return generate_serialize_cdr(self.fields, self._store, "le")

    @cached_property
    def deserialize_cdr_le(self) -> Any:
        """Reads a value, little-endian."""
        return generate_deserialize_cdr(self.fields, self._store, "le")

    @cached_property
    def deserialize_cdr_be(self) -> Any:
        """Reads a value, big-endian: only of foreign senders."""
        return generate_deserialize_cdr(self.fields, self._store, "be")


class CdrStore(Typestore):  # type: ignore[misc]
    """A store that knows CDR alone; of types that it does not know yet it takes rosbags' of ROS 2 Jazzy."""

    def __init__(self, definitions: Mapping[str, Definition], max_sequence_length: int) -> None:
        super().__init__(max_sequence_length=max_sequence_length)
        self.fielddefs.update(definitions)
        self.types = _Classes(self.fielddefs)

    def get_msgdef(self, typename: str) -> CdrDefinition:
        """The definition of a ROS type, by its name.

        Raises:
          KeyError: The type is unknown.
        """
        known: CdrDefinition | None = self.cache.get(typename)
        if known is None:
            self.require([typename])
            known = self.cache[typename] = CdrDefinition(self, typename)
        return known

    def hash_rihs01(self, typ: str) -> str:
        """RIHS01 hash of a ROS type, by its name; KeyError if it is unknown."""
        self.require([typ])
        return str(super().hash_rihs01(typ))

    def register(self, typs: Mapping[str, Definition]) -> None:
        """Add types by their definitions; a TypesysError if one of them is known with another definition."""
        self.require({*typs, *parts(typs.values())} - typs.keys())
        super().register(typs)

    def require(self, names: Iterable[str]) -> None:
        """Load all types of ROS 2 Jazzy if one of these is unknown."""
        if self.fielddefs.keys() >= set(names):
            return
        from rosbags.typesys.stores import ros2_jazzy

        for name in ros2_jazzy.FIELDDEFS.keys() - self.fielddefs.keys():
            self.fielddefs[name] = ros2_jazzy.FIELDDEFS[name]
            self.types[name] = getattr(ros2_jazzy, name.replace("/", "__"))


class _Classes(dict[str, Any]):
    """Classes of values by ROS name, each made when it is first looked up."""

    def __init__(self, definitions: Mapping[str, Definition]) -> None:
        super().__init__()
        self._definitions = definitions

    def __missing__(self, name: str) -> Any:
        constants, fields = self._definitions[name]
        fixed = {"__msgtype__": name, **{normalize_fieldname(each): value for each, _, value in constants}}
        names = [normalize_fieldname(each) for each, _ in fields]
        self[name] = made = make_dataclass(name.replace("/", "__"), names, namespace=fixed, repr=False, eq=False)
        return made
