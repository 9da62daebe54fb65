"""Text of systemd unit files: sections of settings, and command lines quoted so that systemd expands nothing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tailor.schemas.errors import UsageError

Settings = Iterable[tuple[str, str]]
_ARGUMENT = str.maketrans({"\\": "\\\\", '"': '\\"', "%": "%%", "$": "$$"})
_PATH = str.maketrans({"%": "%%"})


def unit_text(comment: str, sections: Mapping[str, Settings]) -> str:
    """A unit file; a setting may occur several times."""
    parts = [f"# {comment}\n"]
    for name, settings in sections.items():
        parts.append(f"[{name}]\n" + "".join(f"{key}={value}\n" for key, value in settings))
    return "\n".join(parts)


def command_line(arguments: Sequence[str]) -> str:
    """Value of ExecStart: every argument arrives as it is, without specifiers (%) and variables ($).

    Raises:
      UsageError: An argument has a control character, which no unit file can hold.
    """
    return " ".join(_quoted(_checked(argument), _ARGUMENT) for argument in arguments)


def path(name: str) -> str:
    """A path as the value of a setting that takes one; quotes would belong to it.

    Raises:
      UsageError: See `command_line`.
    """
    return _checked(name).replace("%", "%%")


def path_in_list(name: str) -> str:
    """A path as the value of a setting that takes several, such as ReadWritePaths.

    Raises:
      UsageError: See `command_line`; also for quotes and backslashes.
    """
    if set(name) & set("\"'\\"):
        raise UsageError(f"{name}: expected a path without quotes and backslashes")
    return _quoted(_checked(name), _PATH)


def _quoted(text: str, escapes: Mapping[int, str]) -> str:
    plain = text and all(c.isalnum() or c in "/._-:=@+," for c in text)
    return text if plain else f'"{text.translate(escapes)}"'


def _checked(text: str) -> str:
    if not text.isprintable():
        raise UsageError(f"{text!r}: expected text that a unit file can hold")
    return text
