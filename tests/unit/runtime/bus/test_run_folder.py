"""The folder of a bus: its passwords are of one run, and only the user who started it reads them."""

import errno
import fcntl
import os
import shutil
import socket
import stat
import threading
from contextlib import ExitStack, suppress
from tempfile import TemporaryDirectory

import pytest

from tailor.runtime.bus.rights import hosted_folder
from tailor.runtime.bus.rights import run_folder as module
from tailor.runtime.bus.rights.folder_watch import RunFolderWatch
from tailor.runtime.bus.rights.hosted_folder import hosted
from tailor.runtime.bus.rights.run_folder import LOCK, PROFILE, SOCKET, USERS, run_folder
from tailor.schemas.errors import UsageError

ENDPOINT = "tcp/127.0.0.1:7999"


@pytest.fixture(autouse=True)
def base(tmp_path, monkeypatch):
    """Folder of all runs, as of a login session."""
    monkeypatch.delenv("TAILOR_RUN_DIR", raising=False)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path / "tailor"


def mode(path):
    return stat.S_IMODE(path.lstat().st_mode)


def test_folder_and_passwords_are_private():
    with hosted(ENDPOINT, ["people", "driver"]) as folder:
        assert (mode(folder.path), mode(folder.path.parent) & 0o022, mode(folder.users_file)) == (0o700, 0, 0o600)


def test_a_user_with_a_group_of_its_own_gets_private_folders_too():
    """The umask of many systems is 002."""
    before = os.umask(0o002)
    try:
        with hosted(ENDPOINT, ["people"]) as folder:
            assert (mode(folder.path), mode(folder.path.parent)) == (0o700, 0o700)
    finally:
        os.umask(before)


def test_the_group_of_a_service_may_read_them(tmp_path, monkeypatch):
    (tmp_path / "s").mkdir(mode=0o750)
    monkeypatch.setenv("TAILOR_RUN_DIR", str(tmp_path / "s"))
    with hosted(ENDPOINT, ["people"]) as folder:
        assert folder.path.parent == tmp_path / "s"
        assert (mode(folder.path), mode(folder.users_file)) == (0o750, 0o640)


def test_a_full_disk_is_named_with_its_folder(monkeypatch):
    """`tailor bus: No space left on device`: of which disk?"""

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(hosted_folder, "_write_secret", full)
    with (
        pytest.raises(UsageError, match=r"tailor/tcp-127.0.0.1-7999: No space left on device, expected a place for "),
        hosted(ENDPOINT, ["people"]),
    ):
        raise AssertionError("it began")
    monkeypatch.undo()
    assert not (run_folder(ENDPOINT).path / LOCK).exists()


def cleaned(folder):
    """What systemd-tmpfiles does with a folder whose files are old: one under a BSD lock it leaves alone."""
    opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return
    finally:
        os.close(opened)
    for path in folder.iterdir():
        path.unlink()


@pytest.mark.promise("P45")
def test_a_cleaner_of_old_files_takes_nobody_the_passwords_of_a_bus_that_runs():
    """Without them `tailor estop` opens no session."""
    with hosted(ENDPOINT, ["people"]) as folder:
        password = folder.password("people")
        cleaned(folder.path)
        assert folder.password("people") == password
    with hosted(ENDPOINT, ["people"]) as folder:
        assert folder.password("people") != password, "the lock ends with the bus"


def test_every_role_has_a_password_of_its_own_and_every_run_new_ones():
    passwords = []
    for _ in range(2):
        with hosted(ENDPOINT, ["people", "driver"]) as folder:
            passwords += [folder.password("people"), folder.password("driver")]
    assert len(set(passwords)) == 4
    assert {len(password) for password in passwords} == {32}


def left_behind(**files):
    """The folder of a run that was killed."""
    folder = run_folder(ENDPOINT)
    folder.path.parent.mkdir(mode=0o700)
    folder.path.mkdir(mode=0o700)
    for name, text in files.items():
        (folder.path / name).write_text(text)
    return folder


def test_passwords_that_a_killed_run_left_behind_are_replaced():
    left_behind(**{USERS: "people:known\n", LOCK: ""})
    with hosted(ENDPOINT, ["people"]) as folder:
        assert folder.password("people") != "known"


def test_an_open_bus_has_no_passwords_of_a_killed_run():
    left_behind(**{USERS: "people:known\n", LOCK: ""})
    with hosted(ENDPOINT, []) as folder:
        assert folder.password("people") is None


def test_nothing_is_left_at_the_end():
    with hosted(ENDPOINT, ["people"]) as folder:
        (folder.path / SOCKET).touch()
    assert not folder.path.exists()


def test_the_end_of_a_bus_whose_folder_was_removed_leaves_that_of_the_next_alone():
    with ExitStack() as first, ExitStack() as second:
        folder = first.enter_context(hosted(ENDPOINT, ["people"]))
        shutil.rmtree(folder.path)
        second.enter_context(hosted(ENDPOINT, ["people"]))
        password = folder.password("people")
        first.close()
        assert (folder.path / LOCK).exists()
        assert folder.password("people") == password is not None
    assert not folder.path.exists()


@pytest.mark.promise("P45")
@pytest.mark.parametrize("removed", [SOCKET, USERS, PROFILE, None])
def test_a_secured_bus_whose_folder_lacks_what_a_session_needs_has_failed(removed):
    with hosted(ENDPOINT, ["people"]) as folder:
        (folder.path / SOCKET).touch()
        watch = RunFolderWatch(ENDPOINT)
        assert watch.failure() == ""
        shutil.rmtree(folder.path) if removed is None else (folder.path / removed).unlink()
        assert f"{folder.path} was removed" in watch.failure()


def test_an_open_bus_needs_no_folder():
    with hosted(ENDPOINT, []) as folder:
        watch = RunFolderWatch(ENDPOINT)
        shutil.rmtree(folder.path)
        assert watch.failure() == ""


def test_a_bus_has_one_owner():
    with (
        hosted(ENDPOINT, ["people"]) as folder,
        pytest.raises(UsageError, match="it runs already"),
        hosted(ENDPOINT, []),
    ):
        pass
    assert not folder.path.exists()


def test_whoever_was_refused_leaves_the_passwords_of_the_owner_alone():
    with hosted(ENDPOINT, ["people"]) as folder:
        before = folder.users_file.read_text()
        with pytest.raises(UsageError), hosted(ENDPOINT, ["people"]):
            pass
        assert folder.users_file.read_text() == before


def test_a_role_without_a_password_opens_no_session():
    with hosted(ENDPOINT, ["people"]) as folder, pytest.raises(UsageError, match="no password for the role driver"):
        folder.password("driver")


def test_a_bus_without_users_is_open():
    with hosted(ENDPOINT, []) as folder:
        assert folder.password("people") is None


def test_passwords_that_cannot_be_read_are_an_error_and_no_open_bus(monkeypatch):
    def refused(self):
        raise PermissionError(13, "Permission denied")

    with hosted(ENDPOINT, ["people"]) as folder:
        monkeypatch.setattr(type(folder.path), "read_text", refused)
        with pytest.raises(UsageError, match="Permission denied, expected a bus of the same user"):
            folder.password("people")


@pytest.mark.parametrize("which", ["of all runs", "of the bus"])
@pytest.mark.parametrize("bits", [0o020, 0o002])
def test_a_folder_that_others_may_write_is_refused(base, which, bits):
    path = base if which == "of all runs" else run_folder(ENDPOINT).path
    path.mkdir(parents=True)
    base.chmod(0o700)
    path.chmod(0o700 | bits)
    with pytest.raises(UsageError, match="expected a folder that only this user may write"), hosted(ENDPOINT, []):
        pass


@pytest.mark.parametrize("which", ["of all runs", "of the bus"])
def test_a_folder_of_another_user_is_refused(base, monkeypatch, which):
    """Only root can give a folder away: others see their own folder with another user's eyes."""
    folder = left_behind()
    if os.getuid() == 0:
        os.chown(base if which == "of all runs" else folder.path, 12345, -1)
    else:
        monkeypatch.setattr(module.os, "getuid", lambda: os.geteuid() + 1)
    with pytest.raises(UsageError, match="expected a folder that only this user may write"), hosted(ENDPOINT, []):
        pass


@pytest.mark.promise("P16")
@pytest.mark.parametrize("which", ["of all runs", "of the bus"])
def test_a_router_in_a_folder_that_others_may_write_is_not_ours(monkeypatch, which):
    """Without a login session the folder lies in /tmp: whoever makes it first would be sent our e-stops."""
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    with TemporaryDirectory() as short, socket.socket(socket.AF_UNIX) as router:
        monkeypatch.setattr(module.tempfile, "gettempdir", lambda: short)
        folder = left_behind()
        router.bind(str(folder.path / SOCKET))
        router.listen()
        assert folder.running()
        (folder.path.parent if which == "of all runs" else folder.path).chmod(0o777)
        assert not folder.running()


def test_a_router_that_stands_still_runs_however_many_wait_for_it(base):
    """A further connection waits for ever, and with it an e-stop that nobody reports as failed."""
    folder = left_behind()
    with ExitStack() as waiting:
        router = waiting.enter_context(socket.socket(socket.AF_UNIX))
        router.bind(str(folder.path / SOCKET))
        router.listen(1)
        for _ in range(5):
            client = waiting.enter_context(socket.socket(socket.AF_UNIX))
            client.setblocking(False)
            with suppress(BlockingIOError):
                client.connect(str(folder.path / SOCKET))
        answers = []
        looking = threading.Thread(target=lambda: answers.append(folder.running()), daemon=True)
        looking.start()
        looking.join(5)
        assert answers == [True]


@pytest.mark.parametrize("name", ["a#b", "a?b", "a\udcff", "\u00fc" * 50])
def test_a_folder_in_which_zenoh_makes_no_socket_is_refused(monkeypatch, name):
    """It made the socket at what stands before a #, where others may reach it; 107 letters may have more bytes."""
    with TemporaryDirectory() as short:
        monkeypatch.setenv("TAILOR_RUN_DIR", f"{short}/{name}")
        with pytest.raises(UsageError, match=r"expected a (shorter )?TAILOR_RUN_DIR"), hosted(ENDPOINT, []):
            pass


@pytest.mark.parametrize("session", ["", "runtime"])
def test_a_session_folder_that_is_not_absolute_counts_as_none(monkeypatch, tmp_path, session):
    """The folder would be below the current one: an e-stop from elsewhere would find no bus."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_RUNTIME_DIR", session)
    monkeypatch.setenv("TAILOR_RUN_DIR", "")
    monkeypatch.setattr(module.tempfile, "gettempdir", lambda: "/elsewhere")
    assert str(run_folder(ENDPOINT).path).startswith(f"/elsewhere/tailor-{os.getuid()}/")


def test_a_link_to_a_folder_is_refused(base, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir(mode=0o700)
    base.mkdir(mode=0o700)
    run_folder(ENDPOINT).path.symlink_to(elsewhere)
    with pytest.raises(UsageError, match="expected a folder that only this user may write"), hosted(ENDPOINT, []):
        pass


def test_buses_of_different_endpoints_share_nothing():
    assert run_folder("tcp/127.0.0.1:7447").path != run_folder("tcp/127.0.0.1:7448").path
    assert run_folder("tcp/../x:1").path.parent == run_folder(ENDPOINT).path.parent
