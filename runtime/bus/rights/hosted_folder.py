"""Owns the folder of a bus that runs: makes it private, writes its passwords, and empties it at the end."""

from __future__ import annotations

import fcntl
import os
import secrets
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from tailor.runtime.bus.rights.run_folder import (
    CERTIFICATE_USER,
    LOCK,
    PROFILE,
    SOCKET,
    VARIABLE,
    RunFolder,
    is_private,
    run_folder,
)
from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import PLAIN, KeyProfile

MAX_SOCKET_BYTES = 107  # Linux: sun_path, without its final zero
NO_SOCKET = b"#?"  # what follows is no part of the name to zenoh, but settings of an endpoint


@contextmanager
def hosted(endpoint: str, users: Sequence[str], keys: KeyProfile = PLAIN) -> Iterator[RunFolder]:
    """Own the folder of a new bus; emptied at the end.

    Args:
      endpoint: Names the bus.
      users: Each gets a fresh password; none: an open bus.
      keys: Keys of the bus; sessions on this machine read them here.

    Raises:
      UsageError: The bus runs already, or the folder cannot be made or is not private.
    """
    folder = run_folder(endpoint)
    _make_private(folder.path)
    _check_socket(folder.path / SOCKET)
    lock = folder.path / LOCK
    with _locked(lock, endpoint) as held, _kept_from_cleaners(folder.path):
        try:
            _fill(folder, users, keys)
            yield folder
        finally:
            if _is_at(held, lock):
                _empty(folder.path)
    with suppress(OSError):  # the next bus at this endpoint has made it again
        folder.path.rmdir()


def _fill(folder: RunFolder, users: Sequence[str], keys: KeyProfile) -> None:
    """Write what sessions read, in the place of what a bus that was killed has left there."""
    try:
        _empty(folder.path)
        _write_secret(folder.path / PROFILE, [f"{keys.profile} {keys.domain}"])
        if users:
            _write_secret(folder.users_file, [f"{user}:{secrets.token_hex(16)}" for user in users])
            _write_secret(folder.certificate_users_file, [CERTIFICATE_USER])
    except OSError as error:  # e.g. a full disk
        raise UsageError(f"{folder.path}: {error.strerror}, expected a place for passwords, see {VARIABLE}") from error


def _check_socket(path: Path) -> None:
    """Raise UsageError for a name at which zenoh makes no socket, or makes one elsewhere, perhaps beside all others."""
    name = os.fsencode(path)
    if len(name) > MAX_SOCKET_BYTES:
        raise UsageError(f"{path.parent}: too long for a socket, expected a shorter {VARIABLE}")
    if set(name) & set(NO_SOCKET) or name.decode(errors="replace").encode() != name:
        raise UsageError(f"{path.parent}: no name for a socket, expected a {VARIABLE} in UTF-8 without # and ?")


@contextmanager
def _locked(path: Path, endpoint: str) -> Iterator[TextIO]:
    """Hold a lock file, which is removed at the end; a lock of a process that has died is free."""
    with path.open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not _is_at(lock, path):
                raise BlockingIOError  # removed by its last owner a moment ago
        except OSError as error:
            raise UsageError(f"bus endpoint {endpoint}: it runs already; expected a free one, see --connect") from error
        try:
            yield lock
        finally:
            if _is_at(lock, path):
                path.unlink()


def _is_at(lock: TextIO, path: Path) -> bool:
    """Whether a lock file is that of the folder: somebody may have removed it, and another bus have made the next."""
    try:
        return os.path.samestat(os.fstat(lock.fileno()), path.stat())
    except OSError:
        return False


@contextmanager
def _kept_from_cleaners(folder: Path) -> Iterator[None]:
    """Hold a BSD lock on a folder, by which systemd-tmpfiles leaves alone what is in it.

    It removes what has lain in /tmp for ten days. Without the passwords nobody could stop a robot from a shell.
    """
    held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(held, fcntl.LOCK_SH)  # waits for a cleaner that is at it, which takes milliseconds
        yield
    finally:
        os.close(held)


def _make_private(path: Path) -> None:
    mode = 0o750 if VARIABLE in os.environ else 0o700
    try:
        path.parent.parent.mkdir(parents=True, exist_ok=True)
        for each in (path.parent, path):  # one by one: `parents` makes them as the umask says, perhaps for a group
            each.mkdir(mode=mode, exist_ok=True)
            if not is_private(each):
                raise UsageError(f"{each}: expected a folder that only this user may write, see {VARIABLE}")
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a place for a private folder, see {VARIABLE}") from error


def _write_secret(path: Path, lines: Sequence[str]) -> None:
    mode = 0o640 if VARIABLE in os.environ else 0o600
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "w") as file:
        file.write("\n".join(lines) + "\n")


def _empty(folder: Path) -> None:
    for path in folder.iterdir():
        if path.name != LOCK:
            path.unlink()
