#!/usr/bin/python3
"""What the doctor says of a machine on which one thing is wrong, and what it advises."""
import unittest

import rostest
from doctor_fixtures import CONTACTORS, EXOSKELETON, ROOT, FakeMachine, process
from unit_fixtures import suite_of

from checkup import computer, device, graph, network, workspace
from checkup.finding import ERROR, NOTE, OK, WARNING, Finding, summary
from checkup.graph import Node, Snapshot
from checkup.machine import Answer, Port

PORT = '/dev/ttyUSB0'
REMOTE = {'ROS_MASTER_URI': 'http://lab2:11311'}


class DoctorTest(unittest.TestCase):
    def assert_well(self, findings):
        for found in findings:
            self.assertEqual((found.level, found.remedy), (OK, ''), found)

    def assert_found(self, findings, level, text, remedy=''):
        """That one finding has the level, and words of these in text and remedy."""
        findings = list(findings)
        for found in findings:
            if found.level == level and text in found.text and remedy in found.remedy:
                self.assertTrue(found.remedy or level in (OK, NOTE), found)
                return
        self.fail(f'no {level} with {text!r} and {remedy!r} among\n' + '\n'.join(map(str, findings)))


class Summary(DoctorTest):
    def test_only_what_prevents_running_is_a_failure(self):
        for levels, text, status in (([OK, NOTE], 'all is well', 0), ([OK, WARNING], 'it runs', 0),
                                     ([WARNING, ERROR, ERROR], '2 prevent running', 1)):
            line, code = summary([Finding(level, 'x', 'y') for level in levels])
            self.assertIn(text, line)
            self.assertEqual(code, status)

    def test_a_remedy_is_indented_line_by_line(self):
        self.assertEqual(str(Finding(ERROR, 'limits', 'too low', 'one\ntwo')),
                         'error   limits      too low\n'
                         '                    do: one\n'
                         '                        two')


class Network(DoctorTest):
    def found(self, **changes):
        return network.check_network(FakeMachine(**changes))

    def test_all_is_well_where_names_lead_to_their_machines(self):
        self.assert_well(self.found())
        self.assert_well(self.found(environment=REMOTE))
        self.assert_well(self.found(hosts={'lab1': ['127.0.1.1']}))  # a master here

    def test_a_master_that_is_not_named(self):
        self.assert_found(self.found(environment={'ROS_MASTER_URI': ''}), ERROR,
                          'ROS_MASTER_URI is not set', 'source build/devel/setup.bash')
        for text in ('lab1', 'http://lab1', 'http://lab1:many'):
            self.assert_found(self.found(environment={'ROS_MASTER_URI': text}), ERROR,
                              f'{text!r}: it has to be http://HOST:PORT', 'export')

    def test_a_master_whose_host_is_unknown(self):
        self.assert_found(self.found(environment={'ROS_MASTER_URI': 'http://lab9:11311'}), ERROR,
                          "'lab9' (ROS_MASTER_URI) does not resolve", '/etc/hosts')

    def test_an_own_name_that_does_not_resolve(self):
        self.assert_found(self.found(host_name='lab9'), ERROR, "host name 'lab9' does not resolve",
                          'export ROS_IP=192.168.1.7')
        self.assert_found(self.found(host_name='lab9', towards=None), ERROR, 'does not resolve',
                          'export ROS_IP=127.0.0.1')
        self.assert_found(self.found(environment={'ROS_HOSTNAME': 'lab9'}), ERROR,
                          "ROS_HOSTNAME 'lab9' does not resolve")

    def test_an_own_name_that_leads_to_itself_for_a_remote_master(self):
        self.assert_found(self.found(environment=REMOTE, hosts={'lab1': ['127.0.1.1'],
                                                                'lab2': ['192.168.1.8']}),
                          ERROR, 'leads to 127.0.1.1, where the machine of the master (lab2) finds itself',
                          'export ROS_IP=192.168.1.7')
        self.assert_found(self.found(environment=dict(REMOTE, ROS_IP='127.0.0.1')), ERROR,
                          "ROS_IP '127.0.0.1' leads to 127.0.0.1")

    def test_an_address_of_another_machine(self):
        self.assert_found(self.found(environment={'ROS_IP': '192.168.1.99'}), ERROR,
                          'leads to 192.168.1.99, which is no address of this machine', 'export ROS_IP=')

    def test_a_firewall(self):
        self.assert_found(self.found(reached=False), ERROR, 'does not answer at its own host name',
                          'firewall')

    def test_two_names(self):
        self.assert_found(self.found(environment={'ROS_HOSTNAME': 'lab1', 'ROS_IP': '192.168.1.7'}),
                          NOTE, 'ROS_HOSTNAME counts', 'unset')


class Computer(DoctorTest):
    def test_all_is_well_on_a_prepared_one(self):
        machine = FakeMachine()
        for check in (computer.check_limits, computer.check_processors, computer.check_display):
            self.assert_well(check(machine))

    def test_a_limit_of_priorities_with_the_line_to_add(self):
        machine = FakeMachine(fifo=False, limits={'rtprio': 0, 'memlock': None})
        self.assert_found(computer.check_limits(machine), WARNING, 'rtprio is 0, 80 are needed',
                          "echo 'ada - rtprio 80' | sudo tee -a /etc/security/limits.d/haptex.conf")
        self.assert_found(computer.check_limits(FakeMachine(fifo=False)), WARNING,
                          'refused, although rtprio is 80', '--cap-add=sys_nice')

    def test_a_limit_of_locked_memory_with_the_line_to_add(self):
        limits = {'rtprio': 80, 'memlock': 8 << 20}
        self.assert_found(computer.check_limits(FakeMachine(limits=limits)), WARNING,
                          'memlock is 8192 KiB', "'ada - memlock unlimited'")
        self.assert_well(computer.check_limits(FakeMachine(limits=limits, is_root=True)))

    def test_a_single_processor(self):
        self.assert_found(computer.check_processors(FakeMachine(count=1)), WARNING, '1 processor:',
                          'another computer')

    def test_a_governor_that_saves_power(self):
        place = '/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor'
        files = {place.format(0): 'performance\n', place.format(1): 'powersave\n'}
        self.assert_found(computer.check_processors(FakeMachine(files=files)), WARNING,
                          'performance, powersave', 'cpupower')
        self.assert_well(computer.check_processors(FakeMachine(files={})))  # a virtual machine

    def test_steal(self):
        self.assert_found(computer.check_processors(FakeMachine(stolen=0.07)), WARNING, 'took 7 %',
                          'fewer virtual machines')

    def test_displays(self):
        for level, text, changes in (
                (NOTE, 'DISPLAY is not set', {'environment': {'DISPLAY': ''}}),
                (WARNING, "display ':0' does not answer", {'commands': {'xdpyinfo': Answer(1, '')}}),
                (NOTE, 'glxinfo is not installed', {'commands': {'xdpyinfo': Answer(0, '')}}),
                (WARNING, 'has no OpenGL', {'commands': {'xdpyinfo': Answer(0, ''),
                                                         'glxinfo': Answer(1, 'Error')}}),
                (NOTE, 'drawn by the processors (llvmpipe', {'commands': {
                    'xdpyinfo': Answer(0, ''),
                    'glxinfo': Answer(0, 'OpenGL renderer string: llvmpipe (LLVM 15)')}})):
            self.assert_found(computer.check_display(FakeMachine(**changes)), level, text)

    def test_versions_are_told(self):
        self.assert_found(computer.check_versions(FakeMachine(), ('1.2.3', '/pkg')), OK,
                          'haptex 1.2.3 (0123abc)')
        self.assert_found(computer.check_versions(FakeMachine(), None), OK, 'Debian GNU/Linux 12')


class Workspace(DoctorTest):
    def test_all_is_well_where_it_is_sourced_and_built(self):
        self.assert_well(workspace.check_workspace(FakeMachine(), ('1.2.3', '/pkg'), True))
        self.assert_well(workspace.check_packages(FakeMachine(), '/pkg'))

    def test_a_workspace_that_is_not_sourced(self):
        found = list(workspace.check_workspace(FakeMachine(), None, False))
        self.assert_found(found, ERROR, 'does not find the package', 'source build/devel/setup.bash')
        self.assert_found(found, ERROR, 'does not find the messages', 'source build/devel/setup.bash')

    def test_programs_that_are_not_built(self):
        machine = FakeMachine(programs=set(workspace.PROGRAMS) - {'proximity'})
        self.assert_found(workspace.check_workspace(machine, ('1', '/pkg'), True), ERROR,
                          'not built, or not found by rosrun: proximity', 'scripts/demo')

    def test_missing_packages_with_what_needs_them(self):
        machine = FakeMachine(commands={'dpkg-query': Answer(0, 'git deinstall\nother installed')})
        found = list(workspace.check_packages(machine, '/pkg'))
        self.assert_found(found, ERROR, 'missing: cmake', 'sudo apt-get install cmake')
        self.assert_found(found, WARNING, 'for scripts/test only: git', 'install git')
        self.assert_found(found, WARNING, 'for rviz and its pictures only: rviz', 'install rviz')

    def test_another_system(self):
        self.assert_found(workspace.check_packages(FakeMachine(commands={}), '/pkg'), NOTE,
                          'there is no dpkg', 'packages.txt')

    def test_headings_of_the_shipped_list_are_known(self):
        listed = workspace.listed_packages((ROOT / 'scripts/packages.txt').read_text('utf-8'))
        self.assertEqual({workspace.purpose_of(heading) for _, heading in listed},
                         {None, *workspace.FOR_SOME.values()})


class Device(DoctorTest):
    def found(self, port=PORT, **changes):
        machine = FakeMachine(files={'/dev/ttyUSB1': '', '/dev/ttyACM0': ''}, **changes)
        return device.check_device(machine, port, None)

    def answer(self, text, *changes):
        for before, after in changes:
            self.assertIn(before, text)
            text = text.replace(before, after)
        return {'ask_device': Answer(0, text)}

    def test_a_good_one_is_told_with_its_versions_and_how_it_is_calibrated(self):
        found = list(self.found())
        self.assert_found(found, OK, 'exoskeleton, version 1, firmware 258, number 1234567')
        self.assert_found(found, OK, 'sensor of the thumb shows 0.003 N')
        self.assert_found(found, NOTE, 'calibrated by homing', 'exoskeleton/home')
        self.assertEqual({finding.level for finding in found}, {OK, NOTE})

    def test_a_port_that_is_not_there(self):
        self.assert_found(self.found('/dev/ttyUSB7'), ERROR,
                          'no /dev/ttyUSB7; there are: /dev/ttyUSB1, /dev/ttyACM0', 'dmesg')

    def test_a_name_is_a_link_in_the_home_of_ros(self):
        self.assert_found(self.found('haptex_exoskeleton'), ERROR,
                          'no /home/ada/.ros/haptex_exoskeleton')
        self.assert_found(self.found('x', environment={'ROS_HOME': '/ros'}), ERROR, 'no /ros/x')

    def test_a_file_that_is_no_port(self):
        self.assert_found(self.found(ports={PORT: Port(False, True, 'ada', 0o644)}), ERROR,
                          'is no serial port')

    def test_permissions(self):
        closed = {PORT: Port(True, False, 'dialout', 0o660)}
        nobody = {True: {'ada'}, False: {'ada'}}
        self.assert_found(self.found(ports=closed, memberships=nobody), ERROR,
                          'may not be read and written by ada (group dialout, 660)',
                          'sudo usermod -aG dialout ada\nlog in again')
        self.assert_found(self.found(ports=closed, memberships={True: {'dialout'}, False: {'ada'}}),
                          ERROR, 'login is older than the membership', 'log in again')
        self.assert_found(self.found(ports={PORT: Port(True, False, 'root', 0o600)},
                                     memberships=nobody), ERROR, 'group root', 'udev')

    def test_who_has_it(self):
        self.assert_found(self.found(open={PORT: [process('exoskeleton_driver')]}), NOTE,
                          'in use by exoskeleton_driver (12)', '/diagnostics')
        self.assert_found(self.found(open={PORT: [process('minicom')]}), ERROR, 'in use by minicom (12)',
                          'end minicom')

    def test_a_program_that_is_not_built(self):
        self.assert_found(self.found(programs=set()), ERROR, 'is not built', 'scripts/demo')

    def test_a_port_that_cannot_be_opened(self):
        found = list(self.found(commands={'ask_device': Answer(1, 'ask_device: input/output error')}))
        self.assert_found(found, ERROR, 'input/output error', 'unplug')
        held = f'ask_device: {PORT}: another program has it open'
        self.assert_found(self.found(commands={'ask_device': Answer(1, held)}), ERROR, held,
                          f'sudo fuser -v {PORT}')

    def test_silence_and_garbage(self):
        silence = 'device: none\ngood_frames: 0\ncorrupt_frames: 0\ngarbage_bytes: 0\nlost_states: 0\n'
        self.assert_found(self.found(commands=self.answer(silence)), ERROR,
                          f'nobody answers at {PORT} within 2 s', '921600 baud')
        self.assert_found(self.found(commands=self.answer(silence, ('bytes: 0', 'bytes: 77'))), ERROR,
                          '77 bytes came that are no frames')

    def test_another_version_of_the_protocol(self):
        commands = self.answer(EXOSKELETON, ('\nversion: 1', '\nversion: 2'))
        self.assert_found(self.found(commands=commands), ERROR,
                          'speaks version 2 of its protocol, this package version 1', 'same version')

    def test_other_encoders(self):
        commands = self.answer(EXOSKELETON, ('\ncounts_per_revolution: 2048',
                                             '\ncounts_per_revolution: 4096'))
        self.assert_found(self.found(commands=commands), ERROR, '4096 counts per revolution',
                          'kCountsPerRevolution')

    def test_a_device_that_says_nothing_more(self):
        self.assert_found(self.found(commands=self.answer(EXOSKELETON, ('states: 490', 'states: 0'))),
                          ERROR, 'sends no states', 'off and on')

    def test_sensors_that_show_what_is_not_there(self):
        commands = self.answer(EXOSKELETON, ('0.001, 0, -0.002', '0.3, 0, -0.4'))
        self.assert_found(self.found(commands=commands), WARNING, 'index shows 0.50 N', 'zero')
        commands = self.answer(EXOSKELETON, ('thumb_saturated: false', 'thumb_saturated: true'))
        self.assert_found(self.found(commands=commands), WARNING, 'thumb is at the end of its range')

    def test_motors_that_are_on(self):
        commands = self.answer(EXOSKELETON, ('motors_off: true', 'motors_off: false'))
        self.assert_found(self.found(commands=commands), WARNING, 'motors are on', 'off and on')

    def test_a_bad_line(self):
        commands = self.answer(EXOSKELETON, ('corrupt_frames: 0', 'corrupt_frames: 6'))
        self.assert_found(self.found(commands=commands), WARNING, '6 of 506 frames were damaged or lost',
                          'cable')

    def test_contactors_with_the_calibration_of_others(self):
        machine = FakeMachine(commands={'ask_device': Answer(0, CONTACTORS)})
        machine.files['/pkg/config/tactile/representative.yaml'] = 'source: not measured'
        found = list(device.check_device(machine, PORT, '/pkg'))
        self.assert_found(found, OK, 'contactors, version 129')
        self.assert_found(found, NOTE, 'not measured', 'calibration:=FILE')

    def test_ports_that_nobody_named(self):
        self.assert_found(device.check_ports(FakeMachine()), OK, f'--device {PORT} asks')
        self.assert_found(device.check_ports(FakeMachine(files={})), NOTE, 'fine with the emulator')
        closed = {PORT: Port(True, False, 'dialout', 0o660)}
        self.assert_found(device.check_ports(FakeMachine(ports=closed, memberships={True: set()})),
                          WARNING, 'may not be read', 'usermod')
        self.assert_found(device.check_ports(FakeMachine(running=[process('ModemManager')])), WARNING,
                          'ModemManager', 'systemctl')


class Graph(DoctorTest):
    NODES = {'/rosout': Node('lab1', True)}

    def test_no_master(self):
        self.assert_found(graph.check_master(FakeMachine(), None), NOTE, 'no master runs', 'roslaunch')
        self.assert_found(graph.check_master(FakeMachine(environment=REMOTE), None), ERROR,
                          'no master answers at lab2, port 11311', 'firewall')

    def test_all_is_well_in_a_graph_of_one_machine(self):
        snapshot = Snapshot(self.NODES)
        for check in (graph.check_master, graph.check_nodes, graph.check_names, graph.check_scenes,
                      graph.check_clocks):
            self.assert_well(check(FakeMachine(), snapshot))

    def test_nodes_that_cannot_be_reached(self):
        nodes = {'/haptex/proximity': Node('lab9', False), '/haptex/driver': Node('lab2', False),
                 '/haptex/cloth': Node('127.0.1.1', False)}
        found = list(graph.check_nodes(FakeMachine(environment=REMOTE), Snapshot(nodes)))
        self.assert_found(found, ERROR, "/haptex/proximity runs on 'lab9', which does not resolve here",
                          '/etc/hosts')
        self.assert_found(found, WARNING, 'without an answer: /haptex/driver', 'rosnode cleanup')
        self.assert_found(found, ERROR, "/haptex/cloth told the master of another machine that it is at "
                          "'127.0.1.1'", 'ROS_IP')

    def test_names_that_are_taken(self):
        nodes = {'/left/haptex/proximity': Node('lab1', True)}
        self.assert_found(graph.check_names(FakeMachine(), Snapshot(nodes)), NOTE,
                          'haptex runs in /left/haptex: proximity', 'Two hands')

    def test_two_graphs_on_the_same_names(self):
        owners = ['/haptex/cloth_simulation', '/haptex/cloth_2']
        self.assert_found(graph.check_names(FakeMachine(), Snapshot({}, {'/haptex/cloth/state': owners})),
                          WARNING, 'is published by /haptex/cloth_2 and /haptex/cloth_simulation', 'end one')

    def test_a_graph_of_another_master(self):
        running = [process('cloth_simulation', 7, ROS_MASTER_URI='http://lab1:11399/'),
                   process('proximity', 8, ROS_MASTER_URI='http://lab1:11311/'), process('bash')]
        found = list(graph.check_processes(FakeMachine(running=running)))
        self.assertEqual(len(found), 1)
        self.assert_found(found, WARNING, 'cloth_simulation (7) runs on this machine for another master, '
                          'http://lab1:11399', 'kill -INT 7')

    def test_a_scene_that_is_not_on_this_machine(self):
        machine = FakeMachine(files={'/home/ada/here.yaml': ''})
        scenes = {'/haptex/a/scene': '/home/ada/here.yaml', '/haptex/b/scene': '/home/ada/there.yaml',
                  '/haptex/c/scene': 'wool_sample', '/haptex/d/scene': 3}
        found = list(graph.check_scenes(machine, Snapshot({}, scenes=scenes)))
        self.assertEqual(len(found), 2)
        self.assert_found(found, OK, '/home/ada/here.yaml (/haptex/a/scene) is on this machine')
        self.assert_found(found, ERROR, '/home/ada/there.yaml (/haptex/b/scene) is not on this machine',
                          'same path')

    def test_clocks_of_other_machines(self):
        nodes = {'/haptex/proximity': Node('lab2', True), '/haptex/force_renderer': Node('lab2', True)}
        for delay, level, text in ((0.0004, OK, '0.4 ms behind, the delay of a message included'),
                                   (0.009, WARNING, '9.0 ms behind; 20 ms are allowed'),
                                   (-0.031, ERROR, '31.0 ms ahead: stamps beyond 20 ms are dropped')):
            snapshot = Snapshot(nodes, delays={'/haptex/proximity': delay + 0.001,
                                               '/haptex/force_renderer': delay, '/other': -9.0})
            self.assert_found(graph.check_clocks(FakeMachine(), snapshot), level,
                              f'the clock of lab2 is {text}', '' if level == OK else 'chrony')
        self.assert_found(graph.check_clocks(FakeMachine(), Snapshot(nodes)), NOTE,
                          'no diagnostics from lab2')
        self.assert_found(graph.check_clocks(FakeMachine(), Snapshot(nodes, simulated_time=True)), NOTE,
                          'time is simulated')


Tests = suite_of(Summary, Network, Computer, Workspace, Device, Graph)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'doctor_units', f'{__name__}.Tests')
