"""Reads the bag of a demo."""
import struct

import numpy as np
import rosbag

from .series import FINGERS, PHASES, Series


def namespace_of(bag):
    """@returns the namespace of the only cloth in a bag, without its last slash
    @throws ValueError naming the bag if there is none or more than one"""
    ending = '/cloth/state'
    found = sorted(topic[:-len(ending)] for topic in bag.get_type_and_topic_info().topics
                   if topic.endswith(ending))
    if len(found) != 1:
        raise ValueError(f'{bag.filename}: has {len(found)} topics that end in {ending}, must have one')
    return found[0]


class Recording:
    """What the bag of a demo holds."""

    def __init__(self, path):
        self.begins = {}  # s since the epoch, by phase
        self.mesh = None
        self.states = Series()  # step, simulated time, positions and forces (particle, 3)
        self.felt = {finger: Series() for finger in FINGERS}  # N, in hand_base
        # Norm of the force, normal force, area, speed of sliding while it slips, all SI.
        self.contact = {finger: Series() for finger in FINGERS}
        # Amplitudes (contactor, channel) in um, and the speed over the fabric in m/s.
        self.tactile = {finger: Series() for finger in FINGERS}
        self.operating = Series()  # state of the exoskeleton, and why it is FAULT
        self.dropped = Series()  # s of simulated time that the cloth has given up since its start
        self.qualities = Series()  # names of those that the cloth has run by
        self.diagnostics = {}  # last values by the end of the status's name
        with rosbag.Bag(path) as bag:
            self.message_count = bag.get_message_count()
            self.read(bag)
        for series in [self.states, self.operating, self.dropped, self.qualities,
                       *self.felt.values(), *self.contact.values(), *self.tactile.values()]:
            series.close()
        self.require(path)

    def read(self, bag):
        """In one pass, because every one unpacks the whole bag."""
        place = namespace_of(bag)
        take = {place + '/cloth/state': self.take_state, place + '/cloth/mesh': self.take_mesh,
                place + '/cloth/quality': self.take_quality,
                place + '/emulator/phase': self.take_phase, '/diagnostics': self.take_diagnostics,
                place + '/exoskeleton/operating_state': self.take_operating}
        for finger in FINGERS:
            of = f'{place}/{finger}'
            take[of + '/measured_cf'] = self.taker(self.felt[finger], parse_wrench)
            take[of + '/contact'] = self.taker(self.contact[finger], parse_contact)
            take[of + '/tactile'] = self.taker(self.tactile[finger], parse_tactile)
        for topic, raw, time in bag.read_messages(list(take), raw=True):
            take[topic](raw, time.to_sec())

    @staticmethod
    def taker(series, parse):
        return lambda raw, _: series.add(*parse(raw))

    def take_state(self, raw, _):
        stamp, *state = parse_state(raw[1])
        self.states.add(stamp, tuple(state))

    def take_mesh(self, raw, _):
        self.mesh = message_of(raw)

    def take_quality(self, raw, time):
        self.qualities.add(time, message_of(raw).quality.name)

    def take_phase(self, raw, time):
        self.begins[message_of(raw).data] = time

    def take_operating(self, raw, time):
        message = message_of(raw)
        self.operating.add(time, (message.state, message.fault))

    def take_diagnostics(self, raw, time):
        for status in message_of(raw).status:
            name = status.name.split(': ')[-1]
            self.diagnostics[name] = {item.key: item.value for item in status.values}
            if name == 'cloth simulation':
                dropped = self.diagnostics[name]['dropped simulated time (s)']
                self.dropped.add(time, float(dropped))

    def require(self, path):
        """Refuses a bag without a whole demo."""
        lacks = [f'phase {phase}' for phase in PHASES + ['end'] if phase not in self.begins]
        if self.mesh is None:
            lacks.append('cloth/mesh')
        if len(self.states.times) < 2:
            lacks.append('cloth/state')
        for finger in FINGERS:
            lacks += [f'{finger}/{topic}' for topic, series in
                      [('measured_cf', self.felt), ('contact', self.contact),
                       ('tactile', self.tactile)] if len(series[finger].times) < 2]
        lacks += [f'diagnostics of the {name}'
                  for name in ['cloth simulation', 'force sources', 'host']
                  if name not in self.diagnostics]
        if lacks:
            raise ValueError(f'{path}: the demo is incomplete, it lacks ' + ', '.join(lacks))
        for phase in PHASES:
            for name, series in [('cloth/state', self.states)] + [
                    (f'{finger}/{topic}', of_topic[finger]) for finger in FINGERS
                    for topic, of_topic in [('measured_cf', self.felt), ('contact', self.contact),
                                            ('tactile', self.tactile)]]:
                if len(series.times[series.within(*self.last_second(phase))]) == 0:
                    raise ValueError(f'{path}: no {name} in the last second of the phase {phase}')

    def tactile_of(self, finger, phase):
        """Amplitudes and speeds of a phase."""
        series = self.tactile[finger]
        return series.values[series.within(*self.span(phase))]

    def span(self, phase):
        """Begin and end of a phase, s since the epoch."""
        names = PHASES + ['end']
        return self.begins[phase], self.begins[names[names.index(phase) + 1]]

    def last_second(self, phase):
        begin, end = self.span(phase)
        return max(begin, end - 1.0), end

    def real_time(self):
        """Simulated and elapsed time of the cloth, s."""
        first, last = self.states.values[0], self.states.values[-1]
        return last[1] - first[1], self.states.times[-1] - self.states.times[0]


def message_of(raw):
    """From what rosbag returns with raw=True: type, data, checksum, place and class."""
    return raw[4]().deserialize(raw[1])


def parse_header(data):
    """Stamp (s) of a serialized std_msgs/Header, and where it ends."""
    _, seconds, nanoseconds, length = struct.unpack_from('<4I', data)
    return seconds + 1e-9 * nanoseconds, 16 + length


def parse_wrench(raw):
    """Stamp and force of a geometry_msgs/WrenchStamped."""
    stamp, offset = parse_header(raw[1])
    return stamp, struct.unpack_from('<3d', raw[1], offset)


def parse_state(data):
    """A serialized haptex/ClothState, much faster than its Python class does it."""
    stamp, offset = parse_header(data)
    _, step, time = struct.unpack_from('<IQd', data, offset)  # the first is the number of the mesh
    offset += 20
    arrays = []
    for _ in range(3):  # positions, velocities, forces
        count, = struct.unpack_from('<I', data, offset)
        arrays.append(np.frombuffer(data, '<f8', 3 * count, offset + 4).reshape(count, 3))
        offset += 4 + 24 * count
    return stamp, step, time, arrays[0], arrays[2]


def parse_contact(raw):
    """A haptex/Contact: stamp, and what Recording.contact holds."""
    stamp, offset = parse_header(raw[1])
    _, slipping, *numbers = struct.unpack_from('<2B15d', raw[1], offset)
    force, normal_force, area, sliding = numbers[:3], numbers[9], numbers[10], numbers[12:15]
    speed = np.linalg.norm(sliding) if slipping else 0.0
    return stamp, (np.linalg.norm(force), normal_force, area, speed)


def parse_tactile(raw):
    """A haptex/Tactile: stamp, and what Recording.tactile holds."""
    message = message_of(raw)
    amplitudes = np.array([message.amplitudes_40, message.amplitudes_320]).T
    return message.header.stamp.to_sec(), (amplitudes, np.hypot(*message.velocity))


def bar_forces(recording):
    """Norm of the force that the bar carries in every state, N."""
    warp = np.array(recording.mesh.rest_warp_coordinates)
    bar = warp > warp.max() - 1e-9
    return np.array([np.linalg.norm(state[3][bar].sum(axis=0))
                     for state in recording.states.values])
