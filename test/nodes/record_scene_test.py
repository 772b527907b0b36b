#!/usr/bin/python3
"""A bag is recorded if the scene lists recording, or if somebody asks for one."""
import pathlib
import signal
import subprocess
import tempfile

import rosbag
import roslib.packages
import rospy
import rostest
from ros_fixtures import NodeTest
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

    def start(self, *arguments):
        program = roslib.packages.find_node('haptex', 'record_scene')[0]
        run = subprocess.Popen([program, *arguments, '--', TOPIC], cwd=self.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
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
            self.assertEqual([message.data for _, message, _ in bag.read_messages()], ['heard'])

    def test_records_what_a_scene_asks_for(self):
        self.assert_records(self.start(self.scene('gravity, recording')), 'sample_*.bag')

    def test_records_what_a_person_asks_for(self):
        self.assert_records(self.start('wool_sample', f'--bag={self.folder}/mine.bag'), 'mine.bag')

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
