"""A bag per trial, by record_topics as a child process."""
import ctypes
import re
import signal
import subprocess

import roslib.packages
import rospy

LONGEST_END = 12.0  # s, for the recorder to close the bag
PR_SET_PDEATHSIG = 1  # of prctl(2)
_libc = ctypes.CDLL(None)


def _end_with_parent():
    """In the child: it closes its bag when the thread that started it dies, however that happens."""
    _libc.prctl(PR_SET_PDEATHSIG, signal.SIGINT)


class TrialRecorder:
    """To be used by one thread, which outlives the bags."""

    def __init__(self, namespace):
        """@param namespace whose topics are recorded but for those that launch/haptex.launch leaves
        out, and for what rviz draws: it can be drawn from the others, and is more than all of them"""
        place = re.escape(namespace.rstrip('/'))
        program = roslib.packages.find_node('haptex', 'record_topics')
        if not program:
            raise OSError('there is no program record_topics')
        self._command = [program[0]]
        self._topics = ['--exclude', place + '/((tactile_)?emulator/.*/.*|exoskeleton/servo_cf)',
                        '--exclude', place + '/.*markers',
                        '--exclude', place + '/evaluation/(cloth|index|thumb)_.*',
                        place + '/.*', '/tf', '/tf_static', '/diagnostics']
        self._process, self._path = None, None

    def start(self, path):
        self._path = path
        self._process = subprocess.Popen([*self._command, str(path), *self._topics],
                                         preexec_fn=_end_with_parent)

    def is_starting(self):
        """Until there is a bag, or the recorder has ended without one."""
        return (self._process is not None and self._process.poll() is None and
                not self._path.with_name(self._path.name + '.active').exists())

    def stop(self):
        """Returns when the bag is closed. One that was not closed in time keeps the suffix .active."""
        if self._process is None:
            return
        process, self._process = self._process, None
        process.send_signal(signal.SIGINT)
        try:
            status = process.wait(LONGEST_END)
        except subprocess.TimeoutExpired:
            process.kill()
            status = process.wait()
        if status != 0:
            rospy.logerr(f'the recorder ended with status {status}: the bag of the trial is not complete')
