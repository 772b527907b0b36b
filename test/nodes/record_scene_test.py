#!/usr/bin/python3
"""A bag is recorded if the scene lists recording, or if somebody asks for one."""
import base64
import os
import pathlib
import resource
import signal
import subprocess
import tempfile

import rosbag
import roslib.packages
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from ros_fixtures import Diagnostics, NodeTest
from std_msgs.msg import String

TOPIC = '/haptex/said'
SCENE = 'fabric: linear\nmodel: [%s]\n'


class RecordScene(NodeTest):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.folder = pathlib.Path(self.place.name)
        self.publisher = rospy.Publisher(TOPIC, String, queue_size=10)
        self.addCleanup(self.publisher.unregister)

    def start(self, *arguments, largest_file=None):
        """@param largest_file bytes, as on a disk that is full then"""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))
        program = roslib.packages.find_node('haptex', 'record_scene')[0]
        run = subprocess.Popen([program, *arguments, '--', TOPIC], cwd=self.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=limit if largest_file else None)
        self.addCleanup(run.kill)
        return run

    def scene(self, model):
        path = self.folder / 'sample.yaml'
        path.write_text(SCENE % model)
        return str(path)

    def ended(self, run):
        output, errors = run.communicate(timeout=30)
        return run.returncode, output, errors

    def assert_records(self, run, pattern):
        self.eventually(self.publisher.get_num_connections, 'nobody records')
        self.publisher.publish('heard')
        self.eventually(lambda: list(self.folder.glob('*.bag.active')), 'there is no bag')
        rospy.sleep(0.5)  # until the message is in it
        run.send_signal(signal.SIGINT)
        self.ended(run)
        bags = list(self.folder.glob(pattern))
        self.assertEqual(len(bags), 1, list(self.folder.iterdir()))
        with rosbag.Bag(bags[0]) as bag:
            said = {topic: message.data for topic, message, _ in bag.read_messages()}
        self.assertEqual(said[TOPIC], 'heard')
        about = yaml.safe_load(said['/recording/about'])
        self.assertTrue(about['scene'].endswith('sample.yaml'), about['scene'])
        self.assertIn('fabric:', about['scene_file'])
        self.assertRegex(about['version'], r'^\d+\.\d+\.\d+$')

    def test_records_what_a_scene_asks_for(self):
        self.assert_records(self.start(self.scene('gravity, recording')), 'sample_*.bag')

    def test_records_what_a_person_asks_for(self):
        self.assert_records(self.start('wool_sample', f'--bag={self.folder}/mine.bag'), 'mine.bag')

    def start_growing(self, **limits):
        """A recorder whose bag grows, and the process that writes it."""
        run = self.start('wool_sample', f'--bag={self.folder}/mine.bag', **limits)
        self.eventually(self.publisher.get_num_connections, 'nobody records')
        incompressible = base64.b64encode(os.urandom(3 << 18)).decode()  # 1 MiB
        stream = rospy.Timer(rospy.Duration(0.1), lambda _: self.publisher.publish(incompressible))
        self.addCleanup(stream.shutdown)
        self.eventually(lambda: sum(path.stat().st_size for path in self.folder.glob('mine.bag*'))
                        > (8 << 20), 'the bag grows')
        rospy.sleep(3.0)  # a few looks
        children = pathlib.Path(f'/proc/{run.pid}/task/{run.pid}/children').read_text().split()
        recorder, = map(int, children)
        return run, recorder

    def assert_says(self, what):
        diagnostics = Diagnostics()
        self.addCleanup(diagnostics.subscriber.unregister)
        self.eventually(lambda: diagnostics.next('recording').level == DiagnosticStatus.ERROR,
                        'an error in the diagnostics')
        self.assertIn(what, diagnostics.next('recording').message)

    def test_says_that_the_recorder_has_died(self):
        run, recorder = self.start_growing()
        os.kill(recorder, signal.SIGKILL)
        self.assert_says('has ended')
        run.send_signal(signal.SIGINT)
        code, _, errors = self.ended(run)
        self.assertNotEqual(code, 0)
        self.assertIn('the bag is not written any more: the recorder has ended', errors)

    def test_says_that_the_disk_is_full_and_what_to_do(self):
        run, _ = self.start_growing(largest_file=100 << 20)
        self.assert_says('the recorder has ended with status 1. Everything else goes on; free space on the '
                         'disk if it is full, and start a recorder again. What it has written is in '
                         f'{self.folder}/mine.bag.active: rosbag reindex')
        self.assertIsNone(run.poll())  # it goes on to say so
        run.send_signal(signal.SIGINT)
        code, _, errors = self.ended(run)
        self.assertEqual(code, 1)
        self.assertIn('the bag is not written any more: the recorder has ended', errors)

    def test_says_that_a_bag_does_not_grow_any_more(self):
        run, recorder = self.start_growing()
        os.kill(recorder, signal.SIGSTOP)
        self.addCleanup(lambda: run.poll() is None and os.kill(recorder, signal.SIGKILL))
        self.assert_says('has not grown')
        os.kill(recorder, signal.SIGCONT)
        run.send_signal(signal.SIGINT)
        self.assertIn('the bag is not written any more', self.ended(run)[2])

    def test_records_nothing_unasked(self):
        for scene in (self.scene('gravity'), 'wool_sample'):
            code, output, errors = self.ended(self.start(scene))
            self.assertEqual(code, 0, errors)
            self.assertIn('does not list recording', output)
        self.assertEqual(list(self.folder.glob('*.bag*')), [])

    def test_refuses_what_is_no_scene(self):
        self.assertEqual(self.ended(self.start('velvet'))[0], 1)
        code, _, errors = self.ended(self.start(self.scene(']')))
        self.assertEqual(code, 1)
        self.assertIn('record_scene: ', errors)


if __name__ == '__main__':
    rospy.init_node('record_scene_test')
    rostest.rosrun('haptex', 'record_scene', RecordScene)
