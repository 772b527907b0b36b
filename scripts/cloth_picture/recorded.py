"""Moments of a bag: where the cloth, what it collides with and the hand were."""
import numpy as np
import rospy

from bag_report.bags import Refused
from bag_report.mechanics import corner_coordinates
from bag_report.reading import as_array

from .looks import Fabric
from .obj_file import Surface
from .solids import Hand, obstacles_of, pose_of_message

WORLD = 'world'
OLDEST_TRANSFORM = 1.0  # s


class Moment:
    """surface of the cloth, which of the fabrics each triangle is of, and solids beside it."""

    def __init__(self, surface, fabric_of, fabrics, solids):
        self.surface, self.fabric_of, self.fabrics, self.solids = surface, fabric_of, fabrics, solids


class Recording:
    """Of an OpenBag (bag_report/bags.py): of one cloth, the first of several."""

    def __init__(self, opened):
        self.bag, self.path = opened.bag, opened.path
        states = sorted(topic for topic, kind in opened.types.items() if kind == 'haptex/ClothState')
        if not states:
            raise Refused(f'{self.path}: no cloth/state (haptex/ClothState) is in it: there is nothing to draw')
        self.state_topic = states[0]
        self.mesh_topic = self.state_topic[:-len('state')] + 'mesh'
        self.begin = self.bag.get_start_time()
        self.times = np.array([time.to_sec() - self.begin for _, _, time
                               in self.bag.read_messages([self.state_topic], raw=True)])
        self.meshes = [(time.to_sec() - self.begin, message) for _, message, time
                       in self.bag.read_messages([self.mesh_topic])]
        if not self.meshes:
            raise Refused(f'{self.path}: {self.mesh_topic} (haptex/ClothMesh) is not in it: without it nobody '
                          'knows the triangles')
        about = [message.data for topic, kind in opened.types.items()
                 if topic.endswith('recording/about') and kind == 'std_msgs/String'
                 for _, message, _ in self.bag.read_messages([topic])]
        self.obstacles = obstacles_of(about[-1]) if about else None
        self.hand = Hand()
        self.still = [transform for _, message, _ in self.bag.read_messages(['/tf_static'])
                      for transform in message.transforms]

    def stamp(self, time):
        return rospy.Time.from_sec(self.begin + time)

    def require_inside(self, time):
        if self.times[0] - 1e-9 <= time <= self.times[-1] + 1e-9:
            return
        raise Refused(f'{self.path}: at {time:g} s there is no cloth in it: allowed are {self.times[0]:.3f} to '
                      f'{self.times[-1]:.3f} s after its begin')

    def state_at(self, time):
        """The newest state then. @param time s after the bag's begin"""
        self.require_inside(time)
        taken = self.times[np.searchsorted(self.times, time + 1e-9, side='right') - 1]
        # Times of a bag are those of the messages' arrival, to a nanosecond.
        found = [message for _, message, _ in self.bag.read_messages(
            [self.state_topic], self.stamp(taken - 1e-5), self.stamp(taken + 1e-5))]
        return found[-1], taken

    def mesh_of(self, state, time):
        before = [message for at, message in self.meshes if at <= time + 1e-9] or [self.meshes[0][1]]
        if before[-1].mesh == state.mesh:
            return before[-1]
        others = [message for _, message in self.meshes if message.mesh == state.mesh]
        if not others:
            raise Refused(f'{self.path}: the cloth at {time:.3f} s has mesh {state.mesh}, of which the bag holds '
                          'no haptex/ClothMesh')
        return others[-1]

    def frames_at(self, time):
        """Poses in the world of all frames that tf told then, by name."""
        parents = {}
        for _, message, _ in self.bag.read_messages(['/tf'], self.stamp(max(0.0, time - OLDEST_TRANSFORM)),
                                                    self.stamp(time)):
            parents.update({transform.child_frame_id: transform for transform in message.transforms})
        parents.update({transform.child_frame_id: transform for transform in self.still})
        poses = {WORLD: np.eye(4)}

        def pose(name, passed):
            if name not in poses:
                link = parents.get(name)
                before = None if link is None or name in passed else pose(link.header.frame_id, passed | {name})
                step = None if before is None else link.transform
                poses[name] = None if step is None else before @ pose_of_message(
                    step.rotation, step.translation)
            return poses[name]
        return {name: found for name in parents if (found := pose(name, frozenset())) is not None}

    def at(self, time):
        state, taken = self.state_at(time)
        message = self.mesh_of(state, taken)
        positions = as_array(state.positions)
        triangles = np.array(message.triangles, dtype=int).reshape(-1, 3)
        particles = len(message.rest_weft_coordinates)
        if len(positions) != particles or len(triangles) == 0 or triangles.max() >= particles \
                or not np.isfinite(positions).all():
            raise Refused(f'{self.path}: the cloth at {taken:.3f} s is not that of its mesh, or not finite')
        rest = np.array([message.rest_weft_coordinates, message.rest_warp_coordinates]).T
        try:
            corners = corner_coordinates(message, rest, triangles)
        except ValueError as error:
            raise Refused(f'{self.path}: {self.mesh_topic}: {error}') from error
        fabrics = [Fabric(name, text) for name, text in zip(message.fabrics, message.fabric_files)]
        fabric_of = np.frombuffer(bytes(getattr(message, 'triangle_fabrics', b'')), np.uint8).astype(int)
        if len(fabric_of) == 0:  # all of the first, and of bags of version 0.1
            fabric_of = np.zeros(len(triangles), dtype=int)
        if len(fabric_of) != len(triangles) or not fabrics or fabric_of.max() >= len(fabrics):
            raise Refused(f'{self.path}: {self.mesh_topic} does not say of which fabric every triangle is')
        solids = self.hand.at(self.frames_at(taken))
        obstacles = [] if self.obstacles is None else \
            self.obstacles.at(state.simulated_time, getattr(state, 'bodies', ()))
        return Moment(Surface(positions, triangles, corners), fabric_of, fabrics, (obstacles, solids))
