#!/usr/bin/python3
"""Protocols are read strictly, orders are balanced, and a session loses no answer. Without a master."""
import collections
import pathlib
import resource
import sys
import unittest

import numpy as np
import rostest
import yaml
from unit_fixtures import Folder, suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'src' / 'nodes' / 'evaluation'))
from haptex_evaluation import strict_yaml  # noqa: E402
from haptex_evaluation.hand import HandPath  # noqa: E402
from haptex_evaluation.latin_square import row_of, williams_rows  # noqa: E402
from haptex_evaluation.plan import STANDARD, TRIAL, trials_of  # noqa: E402
from haptex_evaluation.protocol import PROPERTIES, read_protocol  # noqa: E402
from haptex_evaluation.quoted import quoted  # noqa: E402
from haptex_evaluation.results import read_results  # noqa: E402
from haptex_evaluation.session import Session  # noqa: E402

CONFIG = ROOT / 'config'
SHIPPED = CONFIG / 'protocols' / 'eight_properties.yaml'


class Quoted(unittest.TestCase):
    def test_repeats_at_most_two_hundred_characters_and_says_how_many_there_are(self):
        self.assertEqual(quoted('wool'), "'wool'")
        self.assertEqual(quoted('a' * 200), f"'{'a' * 200}'")
        self.assertEqual(quoted('a' * 10 ** 7), f"'{'a' * 199}... (10000000 characters)")
        self.assertEqual(quoted('\x1b\n'), r"'\x1b\n'")
        self.assertLess(len(quoted(['a' * 1000] * 1000)), 230)


class StrictYaml(Folder):
    def refusal(self, content):
        path = self.folder / 'file.yaml'
        path.write_bytes(content)
        with self.assertRaises(ValueError) as caught:
            strict_yaml.load(path, ['title', 'scale'])
        return str(caught.exception).replace(str(path), 'file')

    def test_tells_nothing_of_a_file_of_another_kind(self):
        for content, says in [
                (b'root:x:0:0:root:/root:/bin/bash\n', 'file: must be a mapping with the keys title, scale'),
                (b'token: secret\n', 'file: has none of the keys title, scale'),
                (b'title: *secret\n', 'file: line 1: is not YAML: found undefined alias'),
                (b'title: [secret\n}', 'file: line 2: is not YAML: expected'),
                (b'title: "\\secret"\n', 'file: line 1: is not YAML: found unknown escape character'),
                (b'title: \x01secret\n', 'file: is not YAML: it has characters that are not allowed'),
                (b'title: \xffsecret\n', 'file: is not UTF-8')]:
            refusal = self.refusal(content)
            self.assertTrue(refusal.startswith(says), refusal)
            self.assertNotIn('secret', refusal)
            self.assertNotIn('root', refusal)


    def test_refuses_what_is_too_large_before_it_is_held(self):
        laughs = 'title: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n' + ''.join(
            f'a{i}: &a{i} [{", ".join(10 * [f"*a{i - 1}"])}]\n' for i in range(1, 9))
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # kB
        for content, says in [
                (b'title: [' + 2_000_000 * b'1,' + b']', 'file: more than 262144 bytes'),
                (b'title: [' + 20_000 * b'1,' + b']', 'file: line 1: more than 20000 values'),
                (b'title: ' + 100_000 * b'[', 'file: line 1: nested deeper than 32 levels'),
                (laughs.encode(), 'file: line 5: more than 20000 values'),
                (b'title: &a [*a]', 'file: line 1: more than 20000 values')]:
            self.assertTrue(self.refusal(content).startswith(says), says)
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 32_000)


class LatinSquares(unittest.TestCase):
    def test_everything_stands_once_in_every_row_and_equally_often_in_every_column(self):
        for count in range(1, 10):
            rows = williams_rows(count)
            self.assertTrue(all(sorted(row) == list(range(count)) for row in rows))
            for column in zip(*rows):
                self.assertEqual(set(collections.Counter(column).values()), {len(rows) // count})

    def test_everything_follows_everything_else_equally_often(self):
        for count in range(2, 10):
            rows = williams_rows(count)
            after = collections.Counter(pair for row in rows for pair in zip(row, row[1:]))
            self.assertEqual(len(after), count * (count - 1))
            self.assertEqual(set(after.values()), {1 if count % 2 == 0 else 2})

    def test_rows_come_again(self):
        self.assertEqual(row_of(6, 7), row_of(6, 1))


class Protocols(Folder):
    def test_eight_properties_of_six_fabrics_take_less_than_thirty_minutes(self):
        protocol = read_protocol(SHIPPED, CONFIG)
        self.assertEqual([each.name for each in protocol.properties], list(PROPERTIES))
        self.assertEqual(len(protocol.samples), 6)
        self.assertEqual(protocol.prescribed_seconds(), 1792)  # 8 (2 (2 + 20) + 6 (2 + 28))

    def refused(self, change, says):
        value = yaml.safe_load(SHIPPED.read_text())
        change(value)
        path = self.folder / 'mine.yaml'
        path.write_text(yaml.safe_dump(value))
        with self.assertRaises(ValueError) as caught:
            read_protocol(path, CONFIG)
        self.assertIn(says, str(caught.exception))
        self.assertIn('mine.yaml', str(caught.exception))

    def test_refuses_what_is_no_protocol_and_says_what_is_allowed(self):
        def first(**values):
            return lambda value: value['properties'][0].update(values)
        for change, says in [
                (lambda value: value.update(colour=1), "unknown key 'colour', allowed are title"),
                (lambda value: value.pop('picture'), 'the key picture is missing'),
                (lambda value: value.update(picture='no'), "picture: 'no' is not allowed"),
                (lambda value: value.update(longest_seconds=1791), 'takes 1792 s, at most'),
                (lambda value: value.update(change_seconds=float('nan')), 'must be a finite number'),
                (lambda value: value.update(fabrics=['wool', 'velvet']), "there is no 'velvet'"),
                (lambda value: value.update(fabrics=['wool', 'wool']), 'wool is there twice'),
                (lambda value: value.update(fabrics=['wool']), '1 sample, must be at least 2'),
                (lambda value: value.update(scale={'least': 3, 'most': 3}), 'must be greater'),
                (first(name='colour'), "name: 'colour' is not allowed, allowed are tensile_stiffness"),
                (first(name='drape'), 'drape is there twice'),
                (first(trial_seconds=0), 'trial_seconds: 0 must be from 1'),
                (first(path='dance'), "path: there is no 'dance'"),
                (first(standards={'low': 'wool', 'high': 'wool'}), 'they must differ'),
                (first(words={'low': 'soft'}), 'the key high is missing'),
                (first(weight=1), "properties[0]: unknown key 'weight'")]:
            with self.subTest(says):
                self.refused(change, says)

    def test_refuses_a_key_that_is_there_twice(self):
        path = self.folder / 'mine.yaml'
        path.write_text(SHIPPED.read_text() + 'picture: false\n')
        with self.assertRaisesRegex(ValueError, "the key 'picture' is there twice"):
            read_protocol(path, CONFIG)


class HandPaths(Folder):
    """As docs/path_files.md tells of the emulator."""

    def path(self, text):
        file = self.folder / 'path.yaml'
        file.write_text(text)
        return HandPath(file)

    def test_moves_with_minimum_jerk_between_key_frames_and_stays_at_the_last(self):
        path = self.path('key_frames:\n'
                         '- {time: 0, index: [0, 0, 0], thumb: [1, 0, 0], position: [0, 0, 0]}\n'
                         '- {time: 2, index: [0, 4, 0], thumb: [1, 0, 0], position: [0, 0, 8],'
                         ' rpy: [0, 0, 1]}\n')
        for time, share in [(-1, 0), (0, 0), (0.5, 0.103515625), (1, 0.5), (2, 1), (9, 1)]:
            (index, thumb, base), turn = path.at(time)
            np.testing.assert_allclose(index, [0, 4 * share, 0], atol=1e-15)
            np.testing.assert_array_equal(thumb, [1, 0, 0])
            np.testing.assert_allclose(base, [0, 0, 8 * share], atol=1e-15)
            np.testing.assert_allclose(turn, [0, 0, np.sin(share / 2), np.cos(share / 2)], atol=1e-15)

    def test_the_paths_that_ship_can_be_followed(self):
        for file in (CONFIG / 'paths').glob('*.yaml'):
            self.assertTrue(np.isfinite(HandPath(file).at(1.0)[0]).all())

    def test_refuses_what_is_no_path(self):
        frame = '- {time: %s, index: [0, 0, 0], thumb: %s, position: [0, 0, 0]}\n'
        for text, says in [(frame % (1, '[0, 0, 0]'), 'time: 1 must be 0 for the first'),
                           (frame % (0, '[0, 0]'), 'thumb: .* must be a list of 3'),
                           (frame % (0, '[0, 0, .nan]'), 'must be a finite number'),
                           (2 * (frame % (0, '[0, 0, 0]')), 'then increasing')]:
            with self.assertRaisesRegex(ValueError, says):
                self.path('key_frames:\n' + text)


class Plans(unittest.TestCase):
    def setUp(self):
        self.protocol = read_protocol(SHIPPED, CONFIG)

    def test_every_property_has_every_fabric_once(self):
        for subject in range(1, 10):
            trials = trials_of(self.protocol, subject)
            pairs = {(trial.property.name, trial.sample) for trial in trials}
            self.assertEqual((len(trials), len(pairs)), (48, 48))
            self.assertEqual(len({trial.code for trial in trials}), 48)
            self.assertEqual(trials, trials_of(self.protocol, subject))

    def test_six_subjects_meet_the_fabrics_of_each_property_in_a_balanced_order(self):
        after = collections.Counter()
        for subject in range(1, 7):
            trials = trials_of(self.protocol, subject)
            for first, second in zip(trials, trials[1:]):
                if second.position > 1:
                    after[first.property.name, first.sample, second.sample] += 1
        self.assertEqual(len(after), 8 * 6 * 5)
        self.assertEqual(set(after.values()), {1})

    def test_refuses_a_subject_without_a_number(self):
        for subject in (0, -1, 1.5, True, '1'):
            with self.assertRaisesRegex(ValueError, 'must be a whole number of at least 1'):
                trials_of(self.protocol, subject)


class Sessions(Folder):
    def setUp(self):
        super().setUp()
        self.protocol = read_protocol(SHIPPED, CONFIG)
        self.warnings = []

    def open(self, who='P1', subject=3):
        session = Session(self.folder / 'session', self.protocol, SHIPPED.read_text(), who, subject,
                          self.warnings.append)
        self.addCleanup(session.close)
        return session

    def results(self):
        return self.folder / 'session' / 'results.csv'

    def rate(self, session, count, now=100.0):
        """Passes standards and answers so many trials. @returns the time afterwards"""
        while count > 0:
            session.begin(now)
            now += session.stage().seconds()
            if session.stage().kind == STANDARD:
                session.end_standard()
            else:
                number = session.stage().trial.number
                session.answer(number, 1 + number % 10, now, session.bag_path().name)
                count -= 1
        return now

    def test_standards_of_both_ends_come_before_the_trials_of_a_property(self):
        session = self.open()
        property_ = session.stage().property
        for word, fabric in zip(property_.words, property_.standards):
            self.assertEqual((session.stage().kind, session.stage().code), (STANDARD, word))
            self.assertEqual(session.stage().sample.fabric, fabric)
            session.begin(0.0)
            session.end_standard()
        self.assertEqual((session.stage().kind, session.stage().trial.number), (TRIAL, 1))

    def test_a_whole_session_is_as_long_as_prescribed_and_leaves_a_line_per_trial(self):
        session = self.open()
        now = self.rate(session, 48, 0.0)
        self.assertEqual(now, 1792 - 64 * 2)  # 64 changes of fabric
        self.assertIsNone(session.stage())
        results, scale = read_results(self.results())
        self.assertEqual((len(results), scale), (48, (1, 10)))
        self.assertEqual(results, session.answered())
        self.assertEqual([(result.trial, result.rating) for result in results],
                         [(number, 1 + number % 10) for number in range(1, 49)])

    def test_goes_on_after_any_byte_that_was_written(self):
        """Killed in the middle of the line of the second answer, at each of its bytes."""
        session = self.open()
        self.rate(session, 2)
        session.close()
        whole = self.results().read_bytes()
        start = whole.rindex(b'\n', 0, -1) + 1
        for end in range(start, len(whole) + 1):
            self.results().write_bytes(whole[:end])
            del self.warnings[:]
            again = self.open()
            complete = end == len(whole)
            self.assertEqual(again.stage().trial.number, 3 if complete else 2)
            self.assertEqual(len(self.warnings), 0 if complete or end == start else 1)
            self.rate(again, 1)
            again.close()
            self.assertEqual(len(read_results(self.results())[0]), 3 if complete else 2)

    def test_goes_on_after_half_a_header(self):
        self.open().close()
        self.results().write_bytes(self.results().read_bytes()[:10])
        session = self.open()
        self.rate(session, 1)
        self.assertEqual(len(read_results(self.results())[0]), 1)

    def test_a_session_that_goes_on_is_the_one_that_was_begun(self):
        whole, parts = self.open(), None
        self.rate(whole, 48)
        expected = [result._replace(began=0, answered=0) for result in whole.answered()]
        whole.close()
        (self.folder / 'session').rename(self.folder / 'whole')
        for _ in range(12):
            parts = self.open()
            self.rate(parts, 4)
            parts.close()
        found = [result._replace(began=0, answered=0) for result in parts.answered()]
        self.assertEqual(found, expected)

    def test_a_full_disk_leaves_no_part_of_a_line(self):
        session = self.open()
        self.rate(session, 1)
        size = self.results().stat().st_size
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        session.begin(0.0)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 5, limits[1]))
        try:
            with self.assertRaises(OSError):
                session.answer(2, 5, 1.0, '')
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        self.assertEqual((self.results().stat().st_size, session.stage().trial.number), (size, 2))
        session.answer(2, 6, 1.0, '')
        self.assertEqual([result.rating for result in read_results(self.results())[0]], [2, 6])

    def test_no_bag_is_written_over(self):
        session = self.open()
        while session.stage().kind == STANDARD:
            session.begin(0.0)
            session.end_standard()
        self.assertEqual(session.bag_path().name, 'trial_01.bag')
        (self.folder / 'session' / 'trial_01.bag.active').write_text('cut off')
        self.assertEqual(session.bag_path().name, 'trial_01_2.bag')
        (self.folder / 'session' / 'trial_01_2.bag').write_text('whole')
        self.assertEqual(session.bag_path().name, 'trial_01_3.bag')

    def test_refuses_answers_that_are_none(self):
        session = self.open()
        session.begin(0.0)
        with self.assertRaisesRegex(ValueError, 'a standard is shown'):
            session.answer(1, 5, 1.0, '')
        session.end_standard()
        with self.assertRaisesRegex(ValueError, 'the standard is not there yet'):
            session.end_standard()
        session.begin(0.0)
        session.end_standard()
        with self.assertRaisesRegex(ValueError, 'the sample is not there yet'):
            session.answer(1, 5, 1.0, '')
        session.begin(0.0)
        for rating in (float('nan'), float('inf'), 0.99, 10.01):
            with self.assertRaisesRegex(ValueError, 'rating: .* must be finite and from 1 to 10'):
                session.answer(1, rating, 1.0, '')
        with self.assertRaisesRegex(ValueError, 'trial: 2 is not the present one, 1'):
            session.answer(2, 5, 1.0, '')
        with self.assertRaisesRegex(ValueError, 'trial 1 has to be answered first'):
            session.end_standard()
        self.assertEqual(session.answered(), [])

    def test_time_runs_from_the_moment_the_sample_is_there(self):
        session = self.open()
        seconds = session.stage().seconds()
        self.assertEqual(session.seconds_left(50.0), seconds)
        session.begin(100.0)
        self.assertEqual(session.seconds_left(101.0), seconds - 1)
        self.assertEqual(session.seconds_left(100.0 + seconds + 1), 0)

    def test_refuses_a_directory_of_another_session_or_in_use(self):
        session = self.open()
        self.rate(session, 1)
        with self.assertRaisesRegex(ValueError, 'another process writes it'):
            self.open()
        session.close()
        with self.assertRaisesRegex(ValueError, 'is of another subject'):
            self.open(subject=4)
        with self.assertRaisesRegex(ValueError, "line 2: .'P1'.* must be .'P2'"):
            self.open(who='P2')
        (self.folder / 'session' / 'protocol.yaml').write_text('another')
        with self.assertRaisesRegex(ValueError, 'is of another protocol'):
            self.open()
        for who in ('', ' ', 'a\nb', 'x' * 81):
            with self.assertRaisesRegex(ValueError, 'who: .* must have 1 to 80'):
                self.open(who)

    def test_refuses_a_file_that_was_spoilt(self):
        session = self.open()
        self.rate(session, 1)
        session.close()
        header, line = self.results().read_text().splitlines()
        cells = line.split(',')
        for column, cell, says in [(8, 'nan', 'rating: nan is not finite'),
                                   (8, '11', 'rating 11 must be from 1 to 10'),
                                   (3, 'colour', "property: 'colour' is not allowed"),
                                   (2, 'one', 'trial: invalid literal')]:
            spoilt = ','.join([*cells[:column], cell, *cells[column + 1:]])
            self.results().write_text(f'{header}\n{spoilt}\n')
            with self.assertRaisesRegex(ValueError, f'line 2: .*{says}|line 2: {says}'):
                self.open()


Tests = suite_of(Quoted, StrictYaml, LatinSquares, Protocols, HandPaths, Plans, Sessions)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'evaluation_sessions', f'{__name__}.Tests')
