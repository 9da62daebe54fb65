"""Counts the messages of a recording and prints the outcome of each action in it."""

import sys
from collections import Counter
from pathlib import Path

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.messages import ActionFinished

GOLDEN = Path(__file__).parents[1] / "tests" / "data" / "golden" / "soccer-approach-dribble.mcap"

recording = open_recording(sys.argv[1] if len(sys.argv) > 1 else GOLDEN)
counts = Counter(recorded.key for recorded in recording.messages())
print(*(f"{count:6} {key}" for key, count in counts.most_common()), sep="\n")
for _, message in recording.decoded():
    if isinstance(message, ActionFinished):
        print(f"{message.action}: {message.outcome}")
