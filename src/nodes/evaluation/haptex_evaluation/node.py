"""The node `evaluation`: leads a person through a session. What it decides is in session.py."""
import os
import pathlib
import queue
import threading
import time

import roslib.packages
import rospy
from haptex.msg import EvaluationTrial
from haptex.srv import AnswerTrial, AnswerTrialResponse
from std_srvs.srv import Trigger, TriggerResponse

from .cloth import Cloth
from .frames import frame_name
from .hand import EmulatedHand
from .picture import Picture
from .plan import STANDARD, TRIAL
from .protocol import VIRTUAL, read_protocol
from .quoted import quoted
from .recording import LONGEST_END, TrialRecorder
from .session import Session
from .strict_yaml import path_of

PERIOD = 0.05  # s, of the loop
SHOW_PERIOD = 1.0  # s, of evaluation/trial
RETRY_PERIOD = 1.0  # s, where the cloth is not there
CHANGE, END = 'CHANGE', 'END'  # states beside STANDARD and TRIAL


class Request:
    """Of a service, for the loop, which does everything in its own thread."""

    def __init__(self, do):
        self.do = do  # @returns a text @throws ValueError with why it is refused
        self.done = threading.Event()
        self.success, self.message = False, ''

    def serve(self):
        try:
            self.message, self.success = self.do(), True
        except (OSError, ValueError) as error:
            self.message = str(error)
        self.done.set()


def _parameter(name, kind, default):
    """@throws ValueError naming the parameter, its value and what it must be"""
    value = rospy.get_param('~' + name, default)
    if isinstance(value, bool) or not isinstance(value, kind):
        raise ValueError(f'{rospy.resolve_name("~" + name)}: {quoted(value)} must be of type {kind.__name__}')
    return value


def _make_session(config):
    """Of the parameters ~protocol, ~session, ~who and ~subject."""
    name = _parameter('protocol', str, 'eight_properties')
    path = path_of(name, config / 'protocols')
    protocol = read_protocol(path, config)
    directory = _parameter('session', str, '')
    if not os.path.isabs(directory):
        raise ValueError(f'{rospy.resolve_name("~session")}: {quoted(directory)} must be an absolute path')
    return Session(directory, protocol, path.read_text('utf-8'), _parameter('who', str, ''),
                   _parameter('subject', int, 1), rospy.logwarn)


class EvaluationNode:
    """@throws ValueError if parameters, protocol or session directory are not as they must be"""

    def __init__(self):
        config = pathlib.Path(roslib.packages.get_pkg_dir('haptex')) / 'config'
        self._session = _make_session(config)
        self._cloth = Cloth(config)
        paths = {each.path for each in self._session.protocol.properties if each.path}
        self._hand = EmulatedHand(config, paths)
        self._picture = Picture(self._session.protocol.picture)
        self._recorder = TrialRecorder(rospy.get_namespace())
        self._requests = queue.Queue()
        self._bag = ''  # name of that of the present trial
        self._is_there = False  # the present sample
        self._left = time.monotonic()  # s; when the stage before ended
        self._next_ask = self._next_show = 0.0  # s, monotonic
        self._publisher = rospy.Publisher('evaluation/trial', EvaluationTrial, queue_size=10,
                                          latch=True)
        self._services = [rospy.Service('evaluation/answer', AnswerTrial, self._take_answer),
                          rospy.Service('evaluation/next', Trigger, self._take_next)]

    def run(self):
        """Until the node is shut down."""
        answered, trials = len(self._session.answered()), len(self._session.trials)
        rospy.loginfo(f'{answered} of {trials} trials are answered in {self._session.directory}')
        try:
            while not rospy.is_shutdown():
                self._step(time.monotonic())
                self._serve_requests()
        finally:
            self._recorder.stop()
            self._hand.stop()
            self._session.close()

    def _serve_requests(self):
        try:
            self._requests.get(timeout=PERIOD).serve()
            self._next_show = 0.0
        except queue.Empty:
            pass

    def _step(self, now):
        stage = self._session.stage()
        if stage is not None:
            self._keep_fabric(stage.sample, now)
            if not self._session.has_begun():
                self._begin_when_there(stage, now)
            elif stage.kind == STANDARD and self._session.seconds_left(time.time()) == 0.0:
                self._session.end_standard()
                self._leave_stage(now)
        if now >= self._next_show:
            self._next_show = now + SHOW_PERIOD
            self._picture.look()
            self._show()

    def _keep_fabric(self, sample, now):
        """Asks for the fabric as long as the cloth has another one, also after it was started anew."""
        if sample.kind != VIRTUAL or self._cloth.has(sample.fabric):
            self._is_there = True
            return
        self._is_there = False
        if now >= self._next_ask:
            self._next_ask = now + RETRY_PERIOD
            refusal = self._cloth.ask_for(sample.fabric)
            if refusal:
                rospy.logwarn(f'the cloth has not changed its fabric yet: {refusal}')

    def _begin_when_there(self, stage, now):
        if not self._is_there:
            return
        if stage.kind == TRIAL and not self._bag:  # it takes a moment to begin
            path = self._session.bag_path()
            self._bag = path.name
            self._recorder.start(path)
        change = self._session.protocol.change_seconds
        if now - self._left < change or self._recorder.is_starting():
            return
        if stage.property.path:
            self._hand.follow(stage.property.path)
        self._session.begin(time.time())
        self._next_show = 0.0

    def _leave_stage(self, now):
        self._hand.stop()
        self._bag, self._is_there, self._left = '', False, now
        self._next_ask = self._next_show = 0.0

    def _answer(self, trial, rating):
        self._session.check_answer(trial, rating)
        answered, now = time.time(), time.monotonic()
        self._recorder.stop()
        has_bag = (self._session.directory / self._bag).exists()
        self._session.answer(trial, rating, answered, self._bag if has_bag else '')
        self._leave_stage(now)
        return f'trial {trial} is rated {rating:g}'

    def _next(self):
        self._session.end_standard()
        self._leave_stage(time.monotonic())
        return 'the next one comes'

    def _done(self, do):
        request = Request(do)
        self._requests.put(request)
        if not request.done.wait(LONGEST_END + 10.0):
            request.message = 'the node is ending or hangs: ask again'
        return request

    def _take_answer(self, question):
        request = self._done(lambda: self._answer(question.trial, question.rating))
        return AnswerTrialResponse(request.success, request.message)

    def _take_next(self, _):
        request = self._done(self._next)
        return TriggerResponse(request.success, request.message)

    def _show(self):
        session, stage = self._session, self._session.stage()
        least, most = session.protocol.scale
        message = EvaluationTrial(state=END, trials=len(session.trials), least_rating=least,
                                  largest_rating=most, with_picture=session.protocol.picture)
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = frame_name('world')
        if stage is not None:
            message.state = stage.kind if session.has_begun() else CHANGE
            message.property = stage.property.name
            message.instruction = stage.property.instruction
            message.low_word, message.high_word = stage.property.words
            message.sample, message.code = stage.sample.kind, stage.code
            message.trial = stage.trial.number if message.state == TRIAL else 0
            message.seconds_left = session.seconds_left(time.time())
        self._publisher.publish(message)


def main():
    """@returns the exit status"""
    rospy.init_node('evaluation')
    try:
        node = EvaluationNode()
    except (OSError, ValueError) as error:
        rospy.logfatal(str(error))
        return 1
    node.run()
    return 0
