"""Leads the emulated hand along a path file: a session without a person, to try a protocol."""
import pathlib
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Point, PointStamped, PoseStamped, Quaternion
from scipy.spatial.transform import Rotation, Slerp

from . import strict_yaml as strict

RATE = 100.0  # Hz
FINGERS = ('index', 'thumb')


class HandPath:
    """As the emulator follows it (docs/path_files.md): minimum jerk from key frame to key frame."""

    def __init__(self, path):
        value = strict.load(path)
        strict.require_keys(value, str(path), ['key_frames'], ['repeat'])
        frames = value['key_frames']
        for i, frame in enumerate(frames):
            strict.require_keys(frame, f'{path}: key_frames[{i}]', ['time', *FINGERS, 'position'],
                                ['rpy', 'phase'])
        self._times = np.array([frame['time'] for frame in frames], float)
        self._places = np.array([frame['index'] + frame['thumb'] + frame['position']
                                 for frame in frames], float)
        self._turns = Rotation.from_euler('xyz', [frame.get('rpy', [0, 0, 0]) for frame in frames])
        self._repeats = value.get('repeat', False)

    def at(self, seconds):
        """@returns positions (m) of index, thumb and hand_base, and the quaternion (x, y, z, w)"""
        last = self._times[-1]
        if self._repeats and last > 0.0:
            seconds %= last
        seconds = min(max(seconds, 0.0), last)
        after = int(np.searchsorted(self._times, seconds, side='right'))
        if after == len(self._times):
            return self._places[-1].reshape(3, 3), self._turns[-1].as_quat()
        before = after - 1
        s = (seconds - self._times[before]) / (self._times[after] - self._times[before])
        s = s ** 3 * (10.0 - 15.0 * s + 6.0 * s * s)
        place = self._places[before] + s * (self._places[after] - self._places[before])
        turn = Slerp([0.0, 1.0], self._turns[[before, after]])(s)
        return place.reshape(3, 3), turn.as_quat()


class EmulatedHand:
    """Publishes <finger>/target and hand_base/target, which a real device does not listen to."""

    def __init__(self, config):
        """@param config the folder with paths/"""
        self._config = pathlib.Path(config)
        self._fingers = [rospy.Publisher(f'{finger}/target', PointStamped, queue_size=1)
                         for finger in FINGERS]
        self._base = rospy.Publisher('hand_base/target', PoseStamped, queue_size=1)
        self._thread, self._ends = None, threading.Event()

    def follow(self, name):
        self.stop()
        file = pathlib.Path(name) if '/' in name else self._config / 'paths' / f'{name}.yaml'
        path = HandPath(file)
        self._ends.clear()
        self._thread = threading.Thread(target=self._run, args=[path], daemon=True)
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
            target.header.stamp, target.header.frame_id = now, 'hand_base'
            publisher.publish(target)
        pose = PoseStamped()
        pose.header.stamp, pose.header.frame_id = now, 'world'
        pose.pose.position, pose.pose.orientation = Point(*positions[2]), Quaternion(*turn)
        self._base.publish(pose)
