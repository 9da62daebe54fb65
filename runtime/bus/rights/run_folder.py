"""Folder of one running bus: its local socket and the passwords of this run, readable by the user who started it.

Processes of the same user find it by the bus's endpoint. Whoever cannot read it opens no session. If TAILOR_RUN_DIR is
set, as for a service, the group of that folder may read it as well.
"""

from __future__ import annotations

import fcntl
import os
import re
import secrets
import socket
import stat
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import PLAIN, PROFILES, KeyProfile

VARIABLE = "TAILOR_RUN_DIR"  # replaces the folder of all runs, e.g. with a service's /run/tailor
SOCKET, USERS, LOCK, CERTIFICATE_USERS = "bus.sock", "users", "lock", "certificate-users"
PROFILE = "key-profile"
CERTIFICATE_USER = "certificate:none"
MAX_SOCKET_BYTES = 107  # Linux: sun_path, without its final zero


@dataclass(frozen=True, slots=True)
class RunFolder:
    """One bus on this machine.

    Attributes:
      path: The folder.
    """

    path: Path

    @property
    def socket_endpoint(self) -> str:
        """zenoh's endpoint of the local socket."""
        return f"unixsock-stream/{self.path / SOCKET}"

    @property
    def users_file(self) -> Path:
        """zenoh's dictionary of users and passwords; missing on an open bus."""
        return self.path / USERS

    @property
    def certificate_users_file(self) -> Path:
        """zenoh's dictionary where a certificate decides; its password is no secret."""
        return self.path / CERTIFICATE_USERS

    @property
    def secured(self) -> bool:
        """Whether the bus runs with passwords."""
        return self.users_file.exists()

    def running(self) -> bool:
        """Whether a router of this bus listens on this machine.

        False for a folder in a place where everybody may make one, if it is not ours: another user's router there
        would take our e-stops, and report them as done.
        """
        if not _is_named() and not all(_is_private(each) for each in (self.path.parent, self.path)):
            return False
        with socket.socket(socket.AF_UNIX) as probe:
            try:
                probe.connect(str(self.path / SOCKET))
            except OSError:
                return False
        return True

    def key_profile(self) -> KeyProfile:
        """Keys of this bus; the plain ones if its folder does not name any."""
        try:
            profile, domain = (self.path / PROFILE).read_text().split()
        except (OSError, ValueError):
            return PLAIN
        return next((KeyProfile(each, int(domain)) for each in PROFILES if each == profile), PLAIN)

    def password(self, user: str) -> str | None:
        """Password of a role in this run; None on an open bus.

        Raises:
          UsageError: The bus has passwords, but none for this role or none that this user may read.
        """
        try:
            lines = self.users_file.read_text().splitlines()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise UsageError(f"{self.users_file}: {error.strerror}, expected a bus of the same user") from error
        found = dict(line.split(":", 1) for line in lines).get(user)
        if found is None:
            raise UsageError(f"{self.users_file}: no password for the role {user}")
        return found


def run_folder(endpoint: str) -> RunFolder:
    """Folder of the bus that listens at `endpoint`, whether it runs or not."""
    return RunFolder(_base() / re.sub(r"[^A-Za-z0-9.]+", "-", endpoint).strip("-"))


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
    if len(str(folder.path / SOCKET)) > MAX_SOCKET_BYTES:
        raise UsageError(f"{folder.path}: too long for a socket, expected a shorter {VARIABLE}")
    with _locked(folder.path / LOCK, endpoint):
        try:
            _empty(folder.path)
            _write_secret(folder.path / PROFILE, [f"{keys.profile} {keys.domain}"])
            if users:
                _write_secret(folder.users_file, [f"{user}:{secrets.token_hex(16)}" for user in users])
                _write_secret(folder.certificate_users_file, [CERTIFICATE_USER])
            yield folder
        finally:
            _empty(folder.path)
    with suppress(OSError):  # the next bus at this endpoint has made it again
        folder.path.rmdir()


@contextmanager
def _locked(path: Path, endpoint: str) -> Iterator[None]:
    """Hold a lock file, which is removed at the end; a lock of a process that has died is free."""
    with path.open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.path.samestat(os.fstat(lock.fileno()), path.stat()):
                raise BlockingIOError  # removed by its last owner a moment ago
        except OSError as error:
            raise UsageError(f"bus endpoint {endpoint}: it runs already; expected a free one, see --connect") from error
        try:
            yield
        finally:
            path.unlink(missing_ok=True)


def _base() -> Path:
    if VARIABLE in os.environ:
        return Path(os.environ[VARIABLE])
    if "XDG_RUNTIME_DIR" in os.environ:
        return Path(os.environ["XDG_RUNTIME_DIR"]) / "tailor"
    return Path(tempfile.gettempdir()) / f"tailor-{os.getuid()}"


def _is_named() -> bool:
    """Whether the environment names the folder of all runs; else it lies where every user may make it first."""
    return VARIABLE in os.environ or "XDG_RUNTIME_DIR" in os.environ


def _is_private(path: Path) -> bool:
    """Whether it is a folder of this user or root, no link, that nobody else may write."""
    try:
        status = path.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and status.st_uid in (0, os.getuid()) and not status.st_mode & 0o022


def _make_private(path: Path) -> None:
    mode = 0o750 if VARIABLE in os.environ else 0o700
    try:
        path.parent.parent.mkdir(parents=True, exist_ok=True)
        for each in (path.parent, path):  # one by one: `parents` makes them as the umask says, perhaps for a group
            each.mkdir(mode=mode, exist_ok=True)
            if not _is_private(each):
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
