"""Readers that share no line with ours decode every message of a recording, own types included, to the same values."""

import json
import shutil
import subprocess
from dataclasses import fields

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.schemas.codec import encode
from tailor.schemas.own import example
from tailor.schemas.typesystem import message_types, ros_type
from tests.support.filled import filled

MESSAGES = message_types()
OWN = [kind for kind in MESSAGES if not kind.ROS_TYPE]
NPM = ["@mcap/core@2", "@foxglove/rosmsg@5", "@foxglove/rosmsg2-serialization@3", "fzstd"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("tape") / "all.mcap"
    tape = McapWriter(path, {})
    for number, kind in enumerate(MESSAGES, start=1):
        message = filled(kind) if kind in OWN else example(kind)
        origin = pack(Origin(number, number, "ab" * 16))
        tape.write(Raw(f"test/{kind.__name__}", encode(message), origin, encoding_of(kind), True, None), number)
    tape.close()
    return path


def plain(value):
    """A ROS value as our dataclasses would hold it: numbers, strings, tuples, nested tuples of fields."""
    if isinstance(value, (str, bool, int, float)):
        return value
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return tuple(map(plain, value))
    names = [name for name in getattr(value, "__slots__", None) or vars(value) if name != "__msgtype__"]
    if set(names) == {"stamp", "frame_id"}:
        return value.stamp.sec * 10**9 + value.stamp.nanosec
    return tuple(plain(getattr(value, name)) for name in names)


def expected(message):
    values = [getattr(message, field.name) for field in fields(message)]
    return tuple(
        tuple(expected(v) if hasattr(v, "__dataclass_fields__") else v for v in value)
        if isinstance(value, tuple)
        else value
        for value in values
    )


def test_mcap_ros2_support_decodes_every_message(recording):
    found = {}
    with recording.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, _, value in reader.iter_decoded_messages():
            found[channel.topic] = (schema.name, value)
    assert found.keys() == {f"/test/{kind.__name__}" for kind in MESSAGES}
    for kind in MESSAGES:
        name, value = found[f"/test/{kind.__name__}"]
        assert name == ros_type(kind)
        if kind in OWN:
            assert plain(value) == expected(filled(kind))


def test_rosbags_decodes_every_message_from_the_schemas_in_the_file(recording):
    with AnyReader([recording]) as reader:
        found = {c.topic: reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages()}
    assert found.keys() == {f"/test/{kind.__name__}" for kind in MESSAGES}
    for kind in OWN:
        assert plain(found[f"/test/{kind.__name__}"]) == expected(filled(kind))


SCRIPT = """
const fs = require("fs");
const { McapIndexedReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const { decompress } = require("fzstd");
const data = fs.readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(data.length),
  read: async (offset, size) => new Uint8Array(data.subarray(Number(offset), Number(offset + size))),
};
(async () => {
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: { zstd: (b) => decompress(b) } });
  const found = {};
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
    found[channel.topic] = new MessageReader(definition).readMessage(message.data);
  }
  console.log(JSON.stringify(found, (_, v) =>
    typeof v === "bigint" ? Number(v) : ArrayBuffer.isView(v) ? Array.from(v, Number) : v));
})();
"""


def listed(value):
    """What JSON makes of our values: tuples as lists."""
    return json.loads(json.dumps(value))


def unnamed(value):
    """A JSON object as the list of its values; a header as its nanoseconds."""
    if isinstance(value, dict) and value.keys() == {"stamp", "frame_id"}:
        return value["stamp"]["sec"] * 10**9 + value["stamp"]["nanosec"]
    if isinstance(value, dict):
        return [unnamed(v) for v in value.values()]
    return [unnamed(v) for v in value] if isinstance(value, list) else value


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("npm") is None, reason="no npm here")
def test_foxgloves_reader_decodes_every_message(recording, tmp_path):
    install = subprocess.run(
        ["npm", "install", "--silent", "--no-save", *NPM], cwd=tmp_path, capture_output=True, timeout=120
    )
    if install.returncode:
        pytest.skip("npm could not install Foxglove's readers")
    (tmp_path / "read.js").write_text(SCRIPT)
    read = subprocess.run(
        ["node", "read.js", recording], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True
    )
    found = json.loads(read.stdout)
    assert found.keys() == {f"/test/{kind.__name__}" for kind in MESSAGES}
    for kind in OWN:
        assert unnamed(found[f"/test/{kind.__name__}"]) == listed(expected(filled(kind)))
