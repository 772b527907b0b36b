"""What a bag says, read in one pass; numbers are kept, messages are not."""
import array
import math
import re
import struct

import genpy
import numpy as np
import yaml

from . import mechanics

FINGERS = ('index', 'thumb')
HEADERS = ['Header'], ['std_msgs/Header']  # types of a first field
WARNING, ERROR = 1, 2  # of diagnostic_msgs/DiagnosticStatus; 3 is stale
LOG_WARNING = 4  # of rosgraph_msgs/Log


class Columns:
    """Rows of numbers that grow without becoming Python objects."""

    def __init__(self, *names):
        self.names = names
        self.data = array.array('d')

    def add(self, *row):
        self.data.extend(row)

    def __len__(self):
        return len(self.data) // len(self.names)

    def table(self):
        """Rows by columns."""
        return np.array(self.data).reshape(-1, len(self.names))


class Arrivals:
    """When the messages of a topic came (s since the epoch)."""

    def __init__(self, has_header):
        self.has_header = has_header
        self.received = array.array('d')
        self.stamps = array.array('d')
        self.sequence = array.array('Q')

    def add(self, received, data):
        self.received.append(received)
        if self.has_header and len(data) >= 16:
            sequence, seconds, nanoseconds = struct.unpack_from('<3I', data)
            self.stamps.append(seconds + 1e-9 * nanoseconds)
            self.sequence.append(sequence)


class Finger:
    def __init__(self):
        self.felt = Columns('time', 'x', 'y', 'z')  # s, N
        # s, N, N, N, -, -, m, m, N, N, m/s, -: friction is the tangential part of the force; along weft
        # and warp is what of it is against the sliding, with the sign of the sliding
        self.contact = Columns('time', 'force', 'normal_force', 'friction', 'slipping', 'fabric',
                               'weft', 'warp', 'along_weft', 'along_warp', 'speed', 'cloth')
        self.tactile = Columns('time', 'mean_40', 'largest_40', 'mean_320', 'largest_320', 'speed',
                               'normal_force')  # s, um, m/s, N
        self.contactors = np.zeros((2, 24))  # um s: amplitudes of 40 and 320 Hz, over time of contact
        self.contactor_time = 0.0  # s


class Cloth:
    """What cloth/mesh said, until it says something else."""

    def __init__(self, time, message, numbers, files):
        self.time = time  # s since the epoch
        self.mesh = message.mesh
        self.mechanics = numbers
        self.fabrics = list(message.fabrics)
        self.files = files  # FabricFile of each; none where its text cannot be read
        # On the stresses of weft, warp and shear, on bending and density; of older bags none.
        self.factors = tuple(getattr(message, 'factors', ())) or 5 * (1.0,)

    def says_the_same_as(self, other):
        return other is not None and (self.mesh, self.fabrics, self.files, self.factors) == \
            (other.mesh, other.fabrics, other.files, other.factors)


class Picture:
    def __init__(self, topic, time, kind, data):
        self.topic, self.time, self.kind, self.data = topic, time, kind, data


class Reading:
    """All that the chapters are made of. Topics are found by their type and the end of their name, in
    any namespace."""

    PICTURES = 6

    def __init__(self, opened):
        bag = opened.bag
        self.types = opened.types
        self.begin, self.end = bag.get_start_time(), bag.get_end_time()
        self.end_read = self.begin
        self.arrivals = {}
        self.about = None  # text of recording/about
        self.cloths = []
        self.mechanics = {}  # by the number of the mesh
        self.fabric_files = {}  # by text
        self.newest = {}  # place in cloths of the newest one of a mesh, by its number
        # s, -, s, -, -, N/m, N/m, number in cloths; not a number without its cloth/mesh
        self.cloth = Columns('time', 'step', 'simulated_time', 'weft_strain', 'warp_strain',
                             'weft_force', 'warp_force', 'cloth')
        self.held = [False, False]  # whether the sides along weft and warp were ever attached
        self.views = []  # (time, mesh number, positions), few
        self.fingers = {finger: Finger() for finger in FINGERS}
        self.qualities = []  # (time, name, cycle, worst cycle), changes of the name
        self.states = []  # (time, what, text), changes
        self.troubles = {}  # (name, level, text without numbers) -> [first, last, count, last text]
        self.pictures = []
        self.unreadable = {}  # topic -> [count, why]
        self.not_finite = {}  # topic -> count
        self.damage = ''  # why reading ended early
        self.takers = self.find_takers()
        self.read(bag)

    def find_takers(self):
        """Who takes the messages of a topic."""
        by_type = {'haptex/ClothMesh': self.take_mesh, 'haptex/ClothState': self.take_state,
                   'haptex/ClothQuality': self.take_quality,
                   'haptex/OperatingState': self.take_operating,
                   'haptex/ArrayState': self.take_array,
                   'diagnostic_msgs/DiagnosticArray': self.take_diagnostics,
                   'rosgraph_msgs/Log': self.take_log,
                   'sensor_msgs/Image': self.take_image,
                   'sensor_msgs/CompressedImage': self.take_compressed}
        of_finger = {'measured_cf': self.take_felt, 'contact': self.take_contact,
                     'tactile': self.take_tactile}
        types = {'measured_cf': 'geometry_msgs/WrenchStamped', 'contact': 'haptex/Contact',
                 'tactile': 'haptex/Tactile'}
        takers = {}
        for topic, name in self.types.items():
            *_, finger, last = ('/' + topic).split('/')
            if finger in FINGERS and types.get(last) == name:
                takers[topic] = (of_finger[last], finger)
            elif name in by_type:
                takers[topic] = (by_type[name], topic)
            elif topic.endswith('recording/about'):
                takers[topic] = (self.take_about, topic)
        return takers

    def read(self, bag):
        headers = {connection.topic: first_field(connection.msg_def).split()[:1] in HEADERS
                   for connection in bag._get_connections()}
        try:
            for topic, raw, time in bag.read_messages(raw=True):
                arrivals = self.arrivals.get(topic)
                if arrivals is None:
                    arrivals = self.arrivals[topic] = Arrivals(headers.get(topic, False))
                received = time.to_sec()
                arrivals.add(received, raw[1])
                self.end_read = received
                if topic in self.takers:
                    self.take(topic, raw, received)
        except Exception as error:  # what rosbag raises depends on what is damaged
            self.damage = f'{type(error).__name__}: {error}'
        self.pictures.sort(key=lambda picture: picture.time)

    def take(self, topic, raw, received):
        taker, of = self.takers[topic]
        try:
            taker(raw[4]().deserialize(raw[1]), received, of)
        except NotFinite:
            self.not_finite[topic] = self.not_finite.get(topic, 0) + 1
        except AttributeError as error:  # bags have their own definitions of messages
            self.not_read(topic, f'they are of another version of the message: {error}')
        except (genpy.DeserializationError, struct.error, ValueError, IndexError, KeyError,
                TypeError) as error:
            self.not_read(topic, str(error))

    def not_read(self, topic, why):
        seen = self.unreadable.setdefault(topic, [0, why])
        seen[0] += 1

    def take_about(self, message, _, __):
        self.about = message.data

    def take_mesh(self, message, received, _):
        self.mechanics[message.mesh] = mechanics.ClothMechanics(message)
        files = [self.fabric_file(text) for text in message.fabric_files]
        cloth = Cloth(received, message, self.mechanics[message.mesh], files)
        if not cloth.says_the_same_as(self.cloths[-1] if self.cloths else None):
            self.cloths.append(cloth)
        self.newest[message.mesh] = len(self.cloths) - 1

    def fabric_file(self, text):
        """None if the text cannot be read."""
        if text not in self.fabric_files:
            try:
                self.fabric_files[text] = mechanics.FabricFile(text)
            except (ValueError, yaml.YAMLError):
                self.fabric_files[text] = None
        return self.fabric_files[text]

    def take_state(self, message, received, _):
        numbers = self.mechanics.get(message.mesh)
        if numbers is None:
            self.cloth.add(received, message.step, message.simulated_time, *5 * [math.nan])
            return
        positions, forces = as_array(message.positions), as_array(message.forces)
        require_finite(positions.sum(), forces.sum())
        self.cloth.add(received, message.step, message.simulated_time, *numbers.strains(positions),
                       *numbers.forces_per_width(forces, positions),
                       self.newest[message.mesh])
        if not all(self.held):
            self.held = [before or now
                         for before, now in zip(self.held, numbers.held(message.attached))]
        wanted = self.begin + len(self.views) * (self.end - self.begin) / self.PICTURES
        if received >= wanted - 1e-6 or not self.views:
            self.views.append((received, message.mesh, positions))

    def take_felt(self, message, received, finger):
        force = message.wrench.force
        require_finite(force.x, force.y, force.z)
        self.fingers[finger].felt.add(received, force.x, force.y, force.z)

    def take_contact(self, message, received, finger):
        force, normal, sliding = (np.array([vector.x, vector.y, vector.z]) for vector in
                                  (message.force, message.normal, message.sliding_velocity))
        friction = force - normal * force.dot(normal)
        speed, fabric_speed = np.linalg.norm(sliding), math.hypot(*message.fabric_velocity)
        along = -friction.dot(sliding) / speed if speed > 0.0 else 0.0
        directed = [along * component / fabric_speed if fabric_speed > 0.0 else 0.0
                    for component in message.fabric_velocity]
        row = (received, np.linalg.norm(force), message.normal_force, np.linalg.norm(friction),
               float(message.slipping), message.fabric, *message.fabric_position, *directed, speed,
               len(self.cloths) - 1)
        require_finite(*row)
        self.fingers[finger].contact.add(*row)

    def take_tactile(self, message, received, finger):
        kept = self.fingers[finger]
        amplitudes = np.array([message.amplitudes_40, message.amplitudes_320])
        require_finite(amplitudes.sum(), message.step_time, message.normal_force, *message.velocity)
        kept.tactile.add(received, amplitudes[0].mean(), amplitudes[0].max(), amplitudes[1].mean(),
                         amplitudes[1].max(), math.hypot(*message.velocity), message.normal_force)
        if message.normal_force > 0.0:
            kept.contactors += message.step_time * amplitudes
            kept.contactor_time += message.step_time

    def take_quality(self, message, received, _):
        row = (received, message.quality.name, message.cycle_ms, message.worst_cycle_ms)
        if not self.qualities or self.qualities[-1][1] != row[1]:
            self.qualities.append(row)

    def take_operating(self, message, received, _):
        self.change(received, 'exoskeleton',
                    message.state + (f': {message.fault}' if message.fault else ''))

    def take_array(self, message, received, topic):
        self.change(received, topic, 'connected' if message.connected else
                    f'not connected: {message.message}')

    def change(self, received, what, text):
        before = [state for state in self.states if state[1] == what]
        if not before or before[-1][2] != text:
            self.states.append((received, what, text))

    def take_diagnostics(self, message, received, _):
        for status in message.status:
            level = status.level if isinstance(status.level, int) else status.level[0]
            if level >= WARNING:
                kind = 'warning' if level == WARNING else 'error'
                self.trouble(received, status.name, kind, status.message)

    def take_log(self, message, received, _):
        if message.level >= LOG_WARNING:
            self.trouble(received, message.name, 'warning' if message.level == LOG_WARNING else
                         'error', message.msg)

    def trouble(self, received, name, kind, text):
        key = name, kind, re.sub(r'[\d.]+', '#', text)
        seen = self.troubles.setdefault(key, [received, received, 0, text])
        seen[1:] = received, seen[2] + 1, text

    def take_compressed(self, message, received, topic):
        kind = 'png' if 'png' in message.format else 'jpeg'
        self.keep_picture(Picture(topic, received, kind, bytes(message.data)))

    def take_image(self, message, received, topic):
        channels = {'rgb8': 3, 'bgr8': 3, 'mono8': 1}.get(message.encoding)
        if channels is None:
            raise ValueError(f'pictures are drawn of rgb8, bgr8 and mono8, not of {message.encoding}')
        if min(message.width, message.height) == 0 or message.step < channels * message.width or \
                len(message.data) != message.height * message.step:
            raise ValueError(f'{len(message.data)} bytes are no picture of {message.width} x '
                             f'{message.height}')
        self.keep_picture(Picture(topic, received, 'raw', message))

    def keep_picture(self, picture):
        """Few, evenly over the bag."""
        kept = [other for other in self.pictures if other.topic == picture.topic]
        if picture.time >= self.begin + len(kept) * (self.end - self.begin) / self.PICTURES:
            if len(kept) < self.PICTURES:
                self.pictures.append(picture)


def first_field(definition):
    """The first line of a message definition that is no comment."""
    for line in definition.splitlines():
        line = line.split('#')[0].strip()
        if line:
            return line
    return ''


class NotFinite(Exception):
    """A message has a number that is not finite: it is left out and counted."""


def require_finite(*values):
    if not np.isfinite(values).all():
        raise NotFinite


def as_array(vectors):
    return np.array([(vector.x, vector.y, vector.z) for vector in vectors]).reshape(-1, 3)
