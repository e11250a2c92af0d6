"""Topics of Unitree's robots over DDS: states in, commands out, and whether somebody else commands too."""

import time
from xml.sax.saxutils import quoteattr

from cyclonedds.core import Policy as QosPolicy
from cyclonedds.core import Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from . import crc
from .error import RobotError
from .messages import LowCmd, LowState, SportModeState
from .state import State

COMMANDS, STATES, ODOMETRY = "rt/lowcmd", "rt/lowstate", "rt/sportmodestate"
LOOPBACK = ("lo", "lo0")
STALE = 0.1  # s after which odometry says nothing any more

# Only the newest counts, and none is lost on the way.
NEWEST = Qos(QosPolicy.Reliability.Reliable(duration(milliseconds=10)), QosPolicy.History.KeepLast(1))
# States come many times a second: a lost one is not asked for again, and a damaged one does not hide the one before.
SENSED = Qos(QosPolicy.Reliability.BestEffort, QosPolicy.History.KeepLast(3))
# A participant hears its own messages otherwise.
OTHERS = Qos(QosPolicy.IgnoreLocal.Participant, QosPolicy.History.KeepLast(1))


def configuration(interface):
    """Of Cyclone DDS: the one network that is used."""
    # Loopback has no multicast on most machines: participants are found by their ports.
    alone = interface in LOOPBACK
    multicast = ' multicast="false"' if alone else ""
    peers = (
        "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>16</MaxAutoParticipantIndex>"
        '<Peers><Peer address="localhost"/></Peers></Discovery>' if alone else ""
    )
    return (
        '<CycloneDDS><Domain Id="any"><General><Interfaces>'
        f'<NetworkInterface name={quoteattr(interface)}{multicast}/></Interfaces></General>{peers}</Domain></CycloneDDS>'
    )


class Participant:
    """One program on a domain and a network; readers and writers of topics."""

    def __init__(self, domain, interface):
        try:
            # It has to outlive what is made in it.
            self._domain = Domain(domain, configuration(interface))
            self._participant = DomainParticipant(domain)
        except Exception as problem:
            raise RobotError(
                f"DDS domain {domain} on interface {interface} cannot be opened ({problem}): name an interface of this "
                "machine (`ip link`) with --interface, and a domain of 0 to 230 with --domain"
            ) from None

    def reader(self, topic, kind, qos=SENSED):
        """Of the newest message."""
        return DataReader(self._participant, Topic(self._participant, topic, kind), qos)

    def writer(self, topic, kind, qos=NEWEST):
        """Reliable, as readers of the robot may ask for it."""
        return DataWriter(self._participant, Topic(self._participant, topic, kind), qos)


def taken(reader):
    """Messages that have not been taken yet, the newest last."""
    return [sample for sample in reader.take(N=8) if not isinstance(sample, InvalidSample)]


def newest(reader):
    """The newest of them, or nothing."""
    found = taken(reader)
    return found[-1] if found else None


class Bus:
    """A robot as a controller meets it. `simulator` hears the odometry too; `dry` sends nothing."""

    def __init__(self, domain, interface, simulator=False, any_checksum=False, dry=False):
        self.place = f"DDS domain {domain}, interface {interface}"
        self.awaited = " and ".join([STATES, ODOMETRY] if simulator else [STATES])
        # Readers and writers end with it.
        self._participant = participant = Participant(domain, interface)
        self._states = participant.reader(STATES, LowState)
        self._rivals = participant.reader(COMMANDS, LowCmd, OTHERS)
        self._odometry = participant.reader(ODOMETRY, SportModeState) if simulator else None
        self._commands = None if dry else participant.writer(COMMANDS, LowCmd)
        self._any_checksum = any_checksum
        self._pelvis, self._told = None, -STALE
        self._tick = None
        self.damaged = 0

    def state(self):
        """The newest state that is new and intact, or nothing; one whose tick stands still is not new."""
        found = [message for message in taken(self._states) if self._is_intact(message)]
        if self._odometry is not None:
            said, now = newest(self._odometry), time.monotonic()
            if said is not None:
                self._pelvis, self._told = (said.position, said.velocity), now
            if now - self._told > STALE:
                return None
        # Some simulators do not count.
        if not found or found[-1].tick == self._tick != 0:
            return None
        self._tick = found[-1].tick
        return State(found[-1], time.monotonic(), self._pelvis)

    def _is_intact(self, message):
        intact = self._any_checksum or crc.is_intact(message, crc.LOW_STATE)
        self.damaged += not intact
        return intact

    @property
    def is_dry(self):
        """Whether nothing is sent."""
        return self._commands is None

    def has_rival(self):
        """Whether another program commands the motors."""
        return newest(self._rivals) is not None

    def send(self, command):
        """Puts the checksum under a LowCmd and sends it, unless this is a dry run."""
        if self._commands is not None:
            self._commands.write(crc.sealed(command, crc.LOW_CMD))
