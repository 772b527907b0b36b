#!/usr/bin/python3
"""A person's session with the cloth that ships: fabrics change, answers are kept, and it goes on
after it was killed."""
import pathlib
import signal
import subprocess
import tempfile

import roslib.packages
import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from haptex.msg import ClothMesh, EvaluationTrial
from haptex.srv import AnswerTrial, SetFabric
from ros_fixtures import WAIT, NodeTest
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

PROTOCOL = """
title: Two properties of three fabrics
longest_seconds: 1000
picture: %s
scale: {least: 1, most: 10}
change_seconds: 0
fabrics: [wool, linen]
real_fabrics: [denim]
properties:
"""
PROPERTY = """
  - name: %s
    instruction: Lift it.
    words: {low: light, high: heavy}
    standards: {low: silk_habutae, high: cotton_canvas}
    trial_seconds: 60
    standard_seconds: 60
"""
NAN = float('nan')


class Evaluation(NodeTest):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        self.mesh = self.trial = None
        subscribers = [rospy.Subscriber('cloth/mesh', ClothMesh, self.take_mesh),
                       rospy.Subscriber('evaluation/trial', EvaluationTrial, self.take_trial)]
        for subscriber in subscribers:
            self.addCleanup(subscriber.unregister)
        self.answer_service = rospy.ServiceProxy('evaluation/answer', AnswerTrial)
        self.next_service = rospy.ServiceProxy('evaluation/next', Trigger)

    def take_mesh(self, mesh):
        self.mesh = mesh

    def take_trial(self, trial):
        self.trial = trial

    def start(self, picture='true', who='P7', more='', subject='1', session='session'):
        """@param more lines of the last property @param session directory in that of the test"""
        protocol = self.folder / 'protocol.yaml'
        protocol.write_text(PROTOCOL % picture + PROPERTY % 'weight' + PROPERTY % 'drape' + more)
        program = roslib.packages.find_node('haptex', 'evaluation')[0]
        self.trial = None
        node = subprocess.Popen(
            [program, f'__ns:={rospy.get_namespace()}', '__name:=evaluation',
             f'_protocol:={protocol}', f'_session:={self.folder / session}', f'_who:={who}',
             f'_subject:={subject}'], stderr=subprocess.PIPE, text=True)
        self.addCleanup(node.communicate)
        self.addCleanup(node.kill)
        return node

    def await_state(self, state, code=None):
        """Of a sample with this code, or with any."""
        self.eventually(lambda: self.trial is not None and self.trial.state == state and
                        code in (None, self.trial.code), lambda: f'{state}: {self.trial}')
        return self.trial

    def pass_standards(self):
        for code in ('light', 'heavy'):
            self.await_state('STANDARD', code)
            response = self.next_service()
            self.assertTrue(response.success, response.message)

    def answer(self, rating):
        """Answers the trial that waits. @returns its number"""
        number = self.await_state('TRIAL').trial
        response = self.answer_service(number, rating)
        self.assertTrue(response.success, response.message)
        self.eventually(lambda: self.trial.trial != number, 'the next trial')
        return number

    def lines(self):
        return (self.folder / 'session' / 'results.csv').read_text().splitlines()

    def assert_touched(self):
        """The cloth has the fabric that the experimenter's list says of the trial."""
        trial = self.await_state('TRIAL')
        lines = (self.folder / 'session' / 'samples.csv').read_text().splitlines()
        _, code, _, sample, fabric = lines[trial.trial].split(',')
        self.assertEqual((trial.code, trial.sample), (code, sample))
        if sample == 'virtual':
            self.assertEqual(self.mesh.fabrics[0], fabric)
        self.assertNotIn(fabric, trial.code + trial.instruction)

    def test_the_fabric_changes_with_the_trials_and_every_answer_has_a_line_and_a_bag(self):
        self.start()
        self.await_state('STANDARD')
        self.assertEqual(self.mesh.fabrics[0], 'silk_habutae')
        self.pass_standards()
        for count in range(1, 4):
            self.assert_touched()
            rospy.sleep(1.0)  # for the bag
            self.assertEqual(self.answer(count), count)
            self.assertEqual(len(self.lines()), 1 + count)
            bag = self.folder / 'session' / self.lines()[-1].split(',')[-1]
            with rosbag.Bag(bag) as opened:
                topics = opened.get_type_and_topic_info().topics
                self.assertIn(rospy.resolve_name('cloth/state'), topics)
                self.assertIn(rospy.resolve_name('evaluation/trial'), topics)
        self.pass_standards()
        for rating in (4, 5, 6):
            self.answer(rating)
        self.await_state('END')
        self.assertEqual(len(self.lines()), 7)
        self.assertIn('the session is over', self.answer_service(6, 3).message)

    def refused(self, response, says):
        self.assertFalse(response.success)
        self.assertIn(says, response.message)

    def test_refuses_answers_that_are_none(self):
        self.start()
        self.await_state('STANDARD')
        self.refused(self.answer_service(1, 3), 'a standard is shown')
        self.pass_standards()
        number = self.await_state('TRIAL').trial
        self.refused(self.answer_service(number, NAN), 'must be finite and from 1 to 10')
        self.refused(self.answer_service(number, 10.5), 'must be finite and from 1 to 10')
        self.refused(self.answer_service(number + 1, 5), f'not the present one, {number}')
        self.refused(self.next_service(), f'trial {number} has to be answered first')
        self.assertEqual(len(self.lines()), 1)
        self.assertEqual(self.answer(5), number)

    def test_goes_on_at_the_first_trial_without_an_answer_after_it_was_killed(self):
        node = self.start()
        self.pass_standards()
        self.assertEqual(self.answer(3), 1)
        self.await_state('TRIAL')
        session = self.folder / 'session'
        self.eventually(lambda: list(session.glob('trial_02.bag*')), 'a bag of the second trial')
        node.send_signal(signal.SIGKILL)
        node.wait()
        self.eventually((session / 'trial_02.bag').exists, 'the recorder closes its bag')
        with open(session / 'results.csv', 'a', encoding='utf-8') as file:
            file.write('P7,1,2,wei')
        again = self.start()
        self.assertEqual(self.answer(7), 2)
        lines = self.lines()
        self.assertEqual([line.split(',')[2] for line in lines[1:]], ['1', '2'])
        self.assertTrue(lines[2].endswith(',trial_02_2.bag'), lines[2])
        self.assertTrue((session / 'trial_02.bag').exists())
        again.send_signal(signal.SIGINT)
        self.assertIn('its last line is not complete and is dropped', again.communicate(timeout=WAIT)[1])

    def test_refuses_the_session_of_somebody_else(self):
        node = self.start()
        self.pass_standards()
        self.answer(3)
        node.kill()
        node.wait()
        other = self.start(who='P8')
        errors = other.communicate(timeout=WAIT)[1]
        self.assertEqual(other.returncode, 1)
        self.assertIn('P8', errors)

    def test_gives_the_cloth_its_fabric_again_that_somebody_changed(self):
        self.start()
        self.await_state('STANDARD')
        changed = []
        subscriber = rospy.Subscriber('cloth/mesh', ClothMesh, lambda mesh: changed.append(mesh.fabrics[0]))
        self.addCleanup(subscriber.unregister)
        self.eventually(lambda: changed, 'a fabric')
        self.assertTrue(rospy.ServiceProxy('cloth/set_fabric', SetFabric)('linear').success)
        self.eventually(lambda: changed == ['silk_habutae', 'linear', 'silk_habutae'], lambda: changed)
        self.assertEqual(self.await_state('STANDARD').code, 'light')

    def test_refuses_parameters_that_are_none(self):
        for arguments, says in [({'subject': '0'}, 'subject: 0 must be a whole number'),
                                ({'subject': 'one'}, "/subject: 'one' must be of type int"),
                                ({'who': '""'}, "who: '' must have 1 to 80"),
                                ({'more': '    colour: 1\n'}, "unknown key 'colour'")]:
            with self.subTest(says):
                node = self.start(**arguments)
                errors = node.communicate(timeout=WAIT)[1]
                self.assertEqual(node.returncode, 1)
                self.assertIn(says, errors)
                self.assertFalse((self.folder / 'session' / 'results.csv').exists())

    def test_leads_an_emulated_hand_where_the_protocol_names_a_path(self):
        got = []
        subscriber = rospy.Subscriber('hand_base/target', PoseStamped, got.append)
        self.addCleanup(subscriber.unregister)
        self.start(more='    path: pinch\n')
        self.eventually(lambda: self.trial is not None, 'a state')
        while self.trial.property != 'drape':
            self.await_state('STANDARD')
            self.assertEqual(got, [])
            self.pass_standards()
            for rating in (1, 2, 3):
                self.answer(rating)
        self.eventually(lambda: len(got) > 10, 'targets of the hand')

    def markers(self, kind):
        """What rviz gets to draw: nothing yet, or markers of the action."""
        got = []
        subscriber = rospy.Subscriber('evaluation/cloth_markers', MarkerArray, got.append)
        self.addCleanup(subscriber.unregister)
        self.eventually(lambda: any(marker.action == kind for array in got for marker in array.markers),
                        'markers')
        return got

    def test_shows_the_picture_or_hides_it(self):
        node = self.start()
        self.assertTrue(self.await_state('STANDARD').with_picture)
        self.markers(Marker.ADD)
        node.send_signal(signal.SIGINT)
        node.wait()
        (self.folder / 'session').rename(self.folder / 'shown')
        self.start(picture='false')
        self.assertFalse(self.await_state('STANDARD').with_picture)
        got = self.markers(Marker.DELETEALL)
        rospy.sleep(1.0)  # 25 pictures, were they passed on
        self.assertEqual(len(got), 1)


if __name__ == '__main__':
    rospy.init_node('evaluation_test')
    rostest.rosrun('haptex', 'evaluation', Evaluation)
