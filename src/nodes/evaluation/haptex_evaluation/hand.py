"""Leads the emulated hand along a path file: a session without a person, to try a protocol."""
import pathlib
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Point, PointStamped, PoseStamped, Quaternion
from scipy.spatial.transform import Rotation, Slerp

from . import strict_yaml as strict
from .frames import frame_name
from .quoted import quoted

RATE = 100.0  # Hz
FINGERS = ('index', 'thumb')


def _vector(value, where):
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(f'{where}: {quoted(value)} must be a list of 3 numbers')
    return [strict.number(item, f'{where}[{i}]') for i, item in enumerate(value)]


class HandPath:
    """As the emulator follows it (docs/path_files.md): minimum jerk from key frame to key frame."""

    def __init__(self, path):
        """@throws ValueError naming file, key and value"""
        value = strict.load(path, ['key_frames'])
        strict.require_keys(value, str(path), ['key_frames'], ['repeat'])
        frames = value['key_frames']
        if not isinstance(frames, list) or not frames:
            raise ValueError(f'{path}: key_frames: {quoted(frames)} must be a list of at least 1')
        times, places, turns = [], [], []
        for i, frame in enumerate(frames):
            where = f'{path}: key_frames[{i}]'
            strict.require_keys(frame, where, ['time', *FINGERS, 'position'], ['rpy', 'phase'])
            times.append(strict.number(frame['time'], f'{where}.time'))
            if times[-1] <= times[-2] if i else times[-1] != 0:
                raise ValueError(f'{where}.time: {times[-1]:g} must be 0 for the first, then increasing')
            places.append([_vector(frame[name], f'{where}.{name}')
                           for name in (*FINGERS, 'position')])
            turns.append(_vector(frame.get('rpy', [0, 0, 0]), f'{where}.rpy'))
        self._times, self._places = np.array(times, float), np.array(places, float)
        self._turns = Rotation.from_euler('xyz', turns)
        self._repeats = strict.one_of(value.get('repeat', False), f'{path}: repeat', (True, False))

    def at(self, seconds):
        """@returns positions (m) of index, thumb and hand_base, and the quaternion (x, y, z, w)"""
        last = self._times[-1]
        if self._repeats and last > 0.0:
            seconds %= last
        seconds = min(max(seconds, 0.0), last)
        after = int(np.searchsorted(self._times, seconds, side='right'))
        if after == len(self._times):
            return self._places[-1], self._turns[-1].as_quat()
        before = after - 1
        s = (seconds - self._times[before]) / (self._times[after] - self._times[before])
        s = s ** 3 * (10.0 - 15.0 * s + 6.0 * s * s)
        place = self._places[before] + s * (self._places[after] - self._places[before])
        turn = Slerp([0.0, 1.0], self._turns[[before, after]])(s)
        return place, turn.as_quat()


class EmulatedHand:
    """Publishes <finger>/target and hand_base/target, which a real device does not listen to."""

    def __init__(self, config, names):
        """@param config the folder with paths/ @param names of those that will be followed
        @throws ValueError naming a file that is no path file"""
        folder = pathlib.Path(config) / 'paths'
        self._paths = {name: HandPath(strict.path_of(name, folder)) for name in names}
        self._fingers = [rospy.Publisher(f'{finger}/target', PointStamped, queue_size=1)
                         for finger in FINGERS]
        self._base = rospy.Publisher('hand_base/target', PoseStamped, queue_size=1)
        self._fixed_frame, self._hand_frame = frame_name('world'), frame_name('hand_base')
        self._thread, self._ends = None, threading.Event()

    def follow(self, name):
        self.stop()
        self._ends.clear()
        self._thread = threading.Thread(target=self._run, args=[self._paths[name]], daemon=True)
        self._thread.start()

    def stop(self):
        """The hand goes back to where its path begins."""
        if self._thread is not None:
            self._ends.set()
            self._thread.join()
            self._thread = None

    def _run(self, path):
        start = time.monotonic()
        while not self._ends.wait(1.0 / RATE):
            self._publish(*path.at(time.monotonic() - start))
        self._publish(*path.at(0.0))

    def _publish(self, positions, turn):
        now = rospy.Time.now()
        for publisher, position in zip(self._fingers, positions):
            target = PointStamped(point=Point(*position))
            target.header.stamp, target.header.frame_id = now, self._hand_frame
            publisher.publish(target)
        pose = PoseStamped()
        pose.header.stamp, pose.header.frame_id = now, self._fixed_frame
        pose.pose.position, pose.pose.orientation = Point(*positions[2]), Quaternion(*turn)
        self._base.publish(pose)
