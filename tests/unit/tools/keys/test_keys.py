"""Keys of a deployment: who signs, what they are valid for, and who may read them. tests/faults tries them live."""

import json
import stat
from datetime import UTC, datetime, timedelta
from threading import Thread

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import serialization
from cryptography.x509.oid import NameOID

from tailor.schemas.errors import UsageError
from tailor.tools.keys.authority import AUTHORITY_KEY, Authority
from tailor.tools.keys.registry import check_name, only_writer, registered_roles, write_role
from tailor.tools.main import main
from tests.support.injection.small_disk import small_disk

NOW = datetime(2026, 11, 22, tzinfo=UTC)


@pytest.fixture
def keys(tmp_path):
    folder = tmp_path / "keys"
    Authority.of(folder, NOW, 30).issue(folder / "driving", "driving", ["10.0.0.7", "robot.local"], NOW, 10)
    return folder


def everything_in(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def certificate(path):
    return x509.load_pem_x509_certificate(path.read_bytes())


def mode(path):
    return stat.S_IMODE(path.lstat().st_mode)


def test_keys_and_their_folders_are_readable_by_their_user_alone(keys):
    assert (mode(keys), mode(keys / "driving")) == (0o700, 0o700)
    assert (mode(keys / AUTHORITY_KEY), mode(keys / "driving" / "key.pem")) == (0o600, 0o600)


def test_a_certificate_names_its_process_and_is_signed_by_the_authority(keys):
    issued, authority = certificate(keys / "driving" / "certificate.pem"), certificate(keys / "authority.pem")
    issued.verify_directly_issued_by(authority)
    assert [each.value for each in issued.subject.get_attributes_for_oid(NameOID.COMMON_NAME)] == ["driving"]
    assert (keys / "driving" / "authority.pem").read_bytes() == (keys / "authority.pem").read_bytes()
    key = serialization.load_pem_private_key((keys / "driving" / "key.pem").read_bytes(), None)
    assert key.public_key() == issued.public_key()


def test_only_the_authority_signs_others(keys):
    def signs(path):
        return certificate(path).extensions.get_extension_for_class(x509.BasicConstraints).value

    assert signs(keys / "authority.pem") == x509.BasicConstraints(True, 0)
    assert signs(keys / "driving" / "certificate.pem") == x509.BasicConstraints(False, None)


def test_a_key_is_valid_for_its_days_alone(keys):
    for path, days in ((keys / "driving" / "certificate.pem", 10), (keys / "authority.pem", 30)):
        issued = certificate(path)
        assert issued.not_valid_before_utc == NOW - timedelta(days=1)
        assert issued.not_valid_after_utc == NOW + timedelta(days=days)


def test_a_key_for_a_few_days_does_not_shorten_the_authority_and_with_it_all_later_keys(tmp_path):
    assert main(["keys", "new", "visitor", "--role", "observer", "--days", "3", "--keys", str(tmp_path)]) == 0
    assert main(["keys", "new", "driving", "--role", "executive", "--keys", str(tmp_path)]) == 0
    ends = [certificate(tmp_path / name).not_valid_after_utc for name in ("authority.pem", "driving/certificate.pem")]
    assert ends[0] > ends[1] + timedelta(days=1000)
    assert certificate(tmp_path / "visitor" / "certificate.pem").not_valid_after_utc < ends[1] - timedelta(days=800)


def test_the_authority_is_made_once(keys):
    before = (keys / AUTHORITY_KEY).read_bytes()
    Authority.of(keys, NOW, 30).issue(keys / "viewing", "viewing", [], NOW, 10)
    assert (keys / AUTHORITY_KEY).read_bytes() == before
    certificate(keys / "viewing" / "certificate.pem").verify_directly_issued_by(certificate(keys / "authority.pem"))


def test_a_revoked_name_has_no_role(tmp_path, capsys):
    write_role(str(tmp_path), "driving", "executive")
    write_role(str(tmp_path), "viewing", "observer")
    assert main(["keys", "revoke", "driving", "--keys", str(tmp_path)]) == 0
    assert registered_roles(str(tmp_path)) == {"viewing": "observer"}


def test_a_name_is_revoked_while_another_command_makes_a_key(tmp_path):
    """Each wrote the table that it had read before: rights that were taken were given back."""
    keys = str(tmp_path)
    with only_writer(keys):
        write_role(keys, "driving", "driver")
        revoking = Thread(target=main, args=(["keys", "revoke", "driving", "--keys", keys],), daemon=True)
        revoking.start()
        revoking.join(0.3)
        assert revoking.is_alive()
        write_role(keys, "people", "people")
    revoking.join(10.0)
    assert registered_roles(keys) == {"people": "people"}


@pytest.mark.parametrize("is_revoked", [True, False])
def test_a_name_never_serves_a_second_key(tmp_path, capsys, is_revoked):
    """Rights go by the name: the first key, moved to its machine or stolen, would have those of the second."""
    write_role(str(tmp_path), "driving", "executive")
    if is_revoked:
        assert main(["keys", "revoke", "driving", "--keys", str(tmp_path)]) == 0
    assert main(["keys", "new", "driving", "--role", "people", "--keys", str(tmp_path)]) == 2
    assert "name 'driving': a key of it was made before, expected a new name" in capsys.readouterr().err
    assert not (tmp_path / "driving").exists()


@pytest.mark.parametrize("table", [{"x": "root"}, {"x": ""}, {"x": []}, ["people"], "people"])
def test_an_unknown_role_is_refused(tmp_path, table):
    (tmp_path / "roles.json").write_text(json.dumps(table))
    with pytest.raises(UsageError, match="expected names with one of the roles"):
        registered_roles(str(tmp_path))


def test_a_table_that_cannot_be_read_is_refused(tmp_path):
    (tmp_path / "roles.json").write_text("[" * 100_000)
    with pytest.raises(UsageError, match="nested too deeply, expected the file that `tailor keys new` writes"):
        registered_roles(str(tmp_path))


@pytest.mark.parametrize("name", ["", "..", "a/b", "a/../../b", ".hidden", "a b", "x" * 64, "a\n"])
def test_a_name_is_no_path(name):
    with pytest.raises(UsageError, match="expected letters, digits"):
        check_name(name)


def test_a_key_is_not_written_over_another_one(keys, capsys):
    before = (keys / "driving" / "key.pem").read_bytes()
    assert main(["keys", "new", "driving", "--role", "executive", "--keys", str(keys)]) == 2
    assert (keys / "driving" / "key.pem").read_bytes() == before


def test_json_for_scripts(tmp_path, capsys):
    keys = str(tmp_path / "keys")
    assert main(["keys", "new", "driving", "--role", "driver", "--keys", keys, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"folder": f"{keys}/driving"}
    assert main(["keys", "list", "--keys", keys, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"driving": "driver"}
    assert main(["keys", "revoke", "driving", "--keys", keys, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"revoked": "driving"}


@pytest.mark.parametrize("name", ["roles.json", "roles.new", "authority.pem", AUTHORITY_KEY])
def test_a_name_takes_no_place_of_a_file(tmp_path, capsys, name):
    assert main(["keys", "new", name, "--role", "people", "--keys", str(tmp_path / "keys")]) == 2
    assert f"name '{name}': a file in the folder of the keys has it" in capsys.readouterr().err
    assert not (tmp_path / "keys").exists()


def test_no_session_is_written_for_an_endpoint_that_takes_no_keys(tmp_path, capsys):
    """The name would be used up: none serves a second key."""
    words = ["keys", "new", "bridge", "--role", "driver", "--keys", str(tmp_path / "keys"), "--for"]
    assert main([*words, "tcp/robot.local:7447"]) == 2
    assert "--for tcp/robot.local:7447: a key opens no session there" in capsys.readouterr().err
    assert not (tmp_path / "keys").exists()
    assert main([*words, "tls/robot.local:7448"]) == 0


@pytest.mark.parametrize("host", ["", "a b", "robot..local", "http://robot", "10.0.0.0/8", "röbot", "-x", "x" * 64])
def test_a_host_that_no_client_could_reach_is_refused(tmp_path, capsys, host):
    assert main(["keys", "new", "router", f"--host={host}", "--keys", str(tmp_path / "keys")]) == 2
    assert capsys.readouterr().err.startswith(f"tailor keys: --host {host!r}: expected a name or an address")
    assert not (tmp_path / "keys").exists()


@pytest.mark.parametrize("host", ["robot", "robot.local", "robot_2.local", "*.robot.local", "10.0.0.5", "fe80::1"])
def test_a_host_may_be_a_name_or_an_address(tmp_path, host):
    assert main(["keys", "new", "router", "--host", host, "--keys", str(tmp_path)]) == 0


def test_a_router_that_no_machine_could_believe_is_not_made(tmp_path, capsys):
    """Its key was made without a name; every other machine was then told that it has no key for the bus."""
    words = ["keys", "new", "router", "--keys", str(tmp_path / "keys")]
    assert main(words) == 2
    assert capsys.readouterr().err.startswith(
        "tailor keys: --host is missing, expected the names or addresses at which"
    )
    assert not (tmp_path / "keys").exists()
    assert main([*words, "--host", "robot.local"]) == 0
    assert main([*words, "--host", "10.0.0.5"]) == 2
    assert "exists already, expected one folder for it: remove that to make it anew" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["authority.pem", AUTHORITY_KEY])
def test_without_its_authority_no_key_is_made_and_no_second_authority(keys, capsys, name):
    """The documentation has people keep the authority's key elsewhere; a new one would part new keys from old ones."""
    moved = (keys / name).rename(keys / "elsewhere")
    before = {path: path.read_bytes() for path in keys.iterdir() if path.is_file()}
    assert main(["keys", "new", "viewing", "--role", "people", "--keys", str(keys)]) == 2
    assert f"{keys / name}: is missing" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in keys.iterdir() if path.is_file()} == before
    moved.rename(keys / name)
    assert main(["keys", "new", "viewing", "--role", "people", "--keys", str(keys)]) == 0


@pytest.mark.parametrize("name", ["authority.pem", AUTHORITY_KEY])
def test_a_damaged_authority_is_named_in_one_line(keys, tmp_path, capsys, name):
    good = (keys / name).read_bytes()
    (keys / name).write_text("junk")
    assert main(["keys", "new", "viewing", "--role", "people", "--keys", str(keys)]) == 2
    assert "cannot be read as PEM" in capsys.readouterr().err
    Authority.of(tmp_path / "other", NOW, 30)
    (keys / name).write_bytes((tmp_path / "other" / name).read_bytes())
    assert main(["keys", "new", "viewing", "--role", "people", "--keys", str(keys)]) == 2
    assert "expected the two that were made together" in capsys.readouterr().err
    (keys / name).write_bytes(good)
    assert not (keys / "viewing").exists()


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (["list", "driving"], "NAME: not of `tailor keys list`"),
        (["list", "--role", "people"], "--role: not of"),
        (["revoke", "driving", "--host", "robot", "--days", "3"], "--host, --days: not of `tailor keys revoke`"),
    ],
)
def test_a_flag_of_another_action_is_not_ignored(keys, capsys, words, wrong):
    write_role(str(keys), "driving", "driver")
    assert main(["keys", *words, "--keys", str(keys)]) == 2
    assert wrong in capsys.readouterr().err
    assert registered_roles(str(keys)) == {"driving": "driver"}


def test_a_folder_without_keys_is_named(tmp_path, capsys):
    assert main(["keys", "list", "--keys", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"{tmp_path}: no keys\n"


def test_a_file_is_no_folder_of_keys(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main(["keys", "list", "--keys", str(tmp_path / "file")]) == 2
    assert "is a file, expected a folder of keys" in capsys.readouterr().err


@pytest.mark.parametrize("limit", [100, 300], ids=["certificate", "private key"])
def test_a_full_disk_leaves_no_half_of_an_authority_which_would_bar_all_keys(tmp_path, capsys, limit):
    words = ["keys", "new", "router", "--host", "robot.local", "--keys", str(tmp_path / "keys")]
    with small_disk(limit):
        assert main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"tailor keys: {tmp_path / 'keys'}")
    assert "File too large, expected" in line
    assert everything_in(tmp_path) == {}
    assert main(words) == 0


@pytest.mark.parametrize("limit", [10, 300, 630])
def test_a_full_disk_costs_no_name_and_leaves_no_half_of_a_key(keys, capsys, limit):
    """The folder without a key barred its name; what was written for a foreign node had no key beside it."""
    write_role(str(keys), "driving", "driver")
    before = everything_in(keys)
    words = ["keys", "new", "bridge", "--role", "driver", "--for", "tls/robot.local:7448", "--keys", str(keys)]
    with small_disk(limit):
        assert main(words) == 2
    assert capsys.readouterr().err == f"tailor keys: {keys}: File too large, expected space for what is written there\n"
    assert everything_in(keys) == before
    assert main(words) == 0
    assert sorted(path.name for path in (keys / "bridge").iterdir()) == [
        "authority.pem", "certificate.pem", "key.pem", "session.json5"
    ]  # fmt: skip
    assert mode(keys / "bridge") == 0o700


def test_a_full_disk_revokes_nothing_and_is_named(keys, capsys):
    write_role(str(keys), "driving", "driver")
    before = everything_in(keys)
    with small_disk(10):
        assert main(["keys", "revoke", "driving", "--keys", str(keys)]) == 2
    expected = f"tailor keys: {keys / 'roles.json'}: File too large, expected a file that can be written\n"
    assert capsys.readouterr().err == expected
    assert everything_in(keys) == before
