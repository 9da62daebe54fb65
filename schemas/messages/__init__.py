"""Typed values of every message on the bus; units are SI unless a name says otherwise (REP-103, REP-105).

Arrays of numbers are tuples, so that every value is frozen and comparable; codec.py converts to bytes. Messages of one
robot alone are imported from their own module, e.g. `tailor.schemas.messages.soccer`.
"""

from tailor.schemas.messages.driving import *
from tailor.schemas.messages.executing import *
from tailor.schemas.messages.launching import *
from tailor.schemas.messages.message import *
from tailor.schemas.messages.planning import *
from tailor.schemas.messages.recording import *
from tailor.schemas.messages.refining import *
from tailor.schemas.messages.sample import *
from tailor.schemas.messages.scenes import *
from tailor.schemas.messages.sensing import *
