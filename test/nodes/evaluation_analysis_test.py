#!/usr/bin/python3
"""KES values are those of the virtual testers, hand values those of the equations, and the analysis
finds what was put into the ratings."""
import csv
import io
import pathlib
import sys
import unittest

import numpy as np
import rostest
import yaml
from unit_fixtures import Folder, suite_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'src' / 'nodes' / 'evaluation'))
from haptex_evaluation import analysis, hand_values  # noqa: E402
from haptex_evaluation.kes_values import UNITS, Curve, FabricValues, find_fabric  # noqa: E402
from haptex_evaluation.plan import trials_of  # noqa: E402
from haptex_evaluation.protocol import PROPERTIES, REAL, VIRTUAL, Sample, read_protocol  # noqa: E402
from haptex_evaluation.results import Result, ResultFile  # noqa: E402

CONFIG = ROOT / 'config'
TOLERANCE = 1e-12


def values_of(name):
    return FabricValues(find_fabric(name, CONFIG))


class KesValues(unittest.TestCase):
    def test_parameters_of_wool_are_those_that_virtual_kes_prints(self):
        """Column put_in of `virtual_kes wool`, which has eight digits and an integral by
        Simpson's rule; means of weft and warp. LC and
        WC of its curve differ by 1e-6 from those of the file."""
        printed = {'LT': (0.53046113 + 0.55991797) / 2, 'WT': (11.036235 + 1.0919087) / 2, 'RT': 65,
                   'G': (5.0863757 + 5.1663209) / 2, '2HG': 0.81577297, '2HG5': 4.0788649,
                   'B': 0.06730127, '2HB': 0.032630919, 'LC': 0.30183583, 'WC': 0.075458956, 'T': 0.41,
                   'MIU': 0.2, 'MMD': 0.016, 'SMD': 4.4}
        found = values_of('wool').parameters
        for name, value in printed.items():
            self.assertLess(abs(found[name] / value - 1), 2e-6 if name in ('LC', 'WC') else 1e-7, name)
        self.assertEqual(found['W'], 15.0)
        self.assertEqual(set(UNITS) - set(found), {'RC'})

    def test_a_curve_is_the_same_by_points_and_by_polynomials(self):
        # Points of a straight line have its slope everywhere, also in one that is mirrored.
        line = Curve({'points': [[0.1, 2.0], [0.3, 6.0]], 'quantity':
                      'second_piola_kirchhoff_over_green_lagrange'}, odd=True)
        cubic = Curve({'polynomials': {'knots': [-1, 0, 1], 'coefficients': [[-20, 20, 0, 0],
                                                                               [0, 20, 0, 0]]}})
        for strain in (-2.0, -0.2, 0.05, 0.25, 3.0):
            self.assertAlmostEqual(line(strain), 20 * strain, delta=TOLERANCE)
            self.assertAlmostEqual(cubic(strain), 20 * strain, delta=TOLERANCE)

    def test_forces_of_a_tester_are_converted_exactly(self):
        curve = Curve({'points': [[0.1, 11.0], [0.2, 24.0]], 'quantity':
                       'force_per_width_over_engineering_strain'})
        self.assertAlmostEqual(curve(0.105), 10.0, delta=TOLERANCE)  # 11 / 1.1 at (1.1^2 - 1) / 2
        self.assertAlmostEqual(curve(0.22), 20.0, delta=TOLERANCE)

    def test_a_linear_fabric_has_the_stiffness_of_its_equation(self):
        # 500 gf/cm = l k (l^2 - 1) / 2 at the stretch l = 1 + EMT.
        stretch = 1 + 500 * 0.980665 / values_of('linear').properties['tensile_stiffness']
        self.assertAlmostEqual(stretch * 100 * (stretch ** 2 - 1) / 2, 490.3325, delta=1e-9)

    def test_values_of_all_properties_but_those_that_a_file_lacks(self):
        self.assertEqual(set(values_of('denim').properties), set(PROPERTIES))
        self.assertEqual(set(PROPERTIES) - set(values_of('linear').properties), {'roughness', 'compressibility'})

    def test_the_drape_is_the_bending_length(self):
        drape = values_of('denim').properties['drape']
        self.assertAlmostEqual(drape ** 3 * 0.324 * 9.80665, (2.0e-5 + 6.4e-5) / 2, delta=1e-18)

    def test_the_shipped_standards_are_the_ends_of_their_scales(self):
        protocol = read_protocol(CONFIG / 'protocols' / 'eight_properties.yaml', CONFIG)
        for each in protocol.properties:
            low, high = (values_of(fabric).properties.get(each.name) for fabric in each.standards)
            between = [values_of(sample.fabric).properties[each.name] for sample in protocol.samples]
            self.assertLessEqual(low, min(between), each.name)
            self.assertGreaterEqual(high, max(between), each.name)

    def test_refuses_a_fabric_that_is_none(self):
        with self.assertRaisesRegex(ValueError, "no fabric 'velvet': allowed is .* wool"):
            values_of('velvet')
        with self.assertRaisesRegex(ValueError, 'rest.yaml: has none of the keys name, areal_density'):
            FabricValues(CONFIG / 'paths' / 'rest.yaml')


# Made up: round numbers, of no fabrics and no publication.
COEFFICIENTS = '''
source: made up for a test
population:
  B: {logarithm: true, mean: -1, deviation: 0.5}
  W: {logarithm: false, mean: 15, deviation: 5}
  RC: {logarithm: false, mean: 50, deviation: 10}
primary:
  - {name: first, constant: 5, coefficients: {B: 2, W: -1}}
  - {name: second, constant: 3, coefficients: {RC: 0.5}}
total:
  constant: 3
  terms:
    first: {linear: 0.5, mean: 2, deviation: 4, quadratic: -1, mean_of_squares: 30, deviation_of_squares: 19}
    second: {linear: 1, mean: 0, deviation: 1, quadratic: 0, mean_of_squares: 0, deviation_of_squares: 1}
assumed: {RC: 60}
'''


class HandValues(Folder):
    def read(self, change=lambda value: None):
        value = yaml.safe_load(COEFFICIENTS)
        change(value)
        path = self.folder / 'mine.yaml'
        path.write_text(yaml.safe_dump(value))
        return hand_values.read_equations(path)

    def test_are_those_of_the_equations(self):
        found, assumed = self.read().values_of({'B': 1.0, 'W': 25.0})
        self.assertAlmostEqual(found['first'], 5 + 2 * 2 - 2, delta=TOLERANCE)  # log10(1) is 2 above
        self.assertAlmostEqual(found['second'], 3.5, delta=TOLERANCE)
        # 0.5 (7 - 2) / 4 - (49 - 30) / 19 + 3.5
        self.assertAlmostEqual(found['THV'], 3 + 0.625 - 1 + 3.5, delta=TOLERANCE)
        self.assertEqual(assumed, ['RC'])

    def test_what_a_file_says_goes_before_what_is_assumed(self):
        found, assumed = self.read().values_of({'B': 0.1, 'W': 15.0, 'RC': 50.0})
        self.assertEqual((found['first'], found['second'], assumed), (5.0, 3.0, []))

    def test_are_printed_with_what_was_assumed(self):
        out = io.StringIO()
        hand_values.print_values(self.read(), [values_of('wool')], out)
        lines = out.getvalue().splitlines()
        self.assertEqual(lines[0], '# coefficients: made up for a test')
        self.assertEqual(lines[1].split('\t'), ['fabric', 'first', 'second', 'THV'])
        first = 5 + 2 * (np.log10(6.6e-6 / 9.80665e-5) + 1) / 0.5
        self.assertEqual(lines[2].split('\t')[:3], ['wool', f'{first:.4g}', '3.5'])
        self.assertEqual(lines[3], '# wool: RC = 60 % is assumed')

    def test_refuses_what_cannot_be_computed(self):
        with self.assertRaisesRegex(ValueError, 'does not say RC, W: add them'):
            self.read(lambda value: value.pop('assumed')).values_of({'B': 1.0})
        with self.assertRaisesRegex(ValueError, 'B: 0 must be greater than 0 for its logarithm'):
            self.read().values_of({'B': 0.0, 'W': 1.0})

    def test_refuses_coefficients_that_are_none_and_says_what_is_allowed(self):
        for change, says in [
                (lambda value: value.update(colour=1), "unknown key 'colour', allowed are source"),
                (lambda value: value.pop('source'), 'the key source is missing'),
                (lambda value: value['population'].update(EMT={}), "unknown key 'EMT', allowed are LT"),
                (lambda value: value['population']['B'].update(deviation=0), 'deviation: 0 must be'),
                (lambda value: value['population']['B'].update(logarithm=1.5), 'logarithm: 1.5'),
                (lambda value: value['population'].pop('W'), "coefficients: unknown key 'W'"),
                (lambda value: value['primary'][0].update(constant=float('inf')), 'finite number'),
                (lambda value: value['primary'][1].update(name='first'), 'first is there twice'),
                (lambda value: value['primary'][1].update(name='THV'), 'THV is the name of'),
                (lambda value: value['total']['terms'].update(third={}), "unknown key 'third'"),
                (lambda value: value['total']['terms']['first'].pop('mean'), 'the key mean is missing'),
                (lambda value: value['assumed'].update(RC='many'), "assumed.RC: 'many' must be")]:
            with self.subTest(says):
                with self.assertRaises(ValueError) as caught:
                    self.read(change)
                self.assertIn(says, str(caught.exception))
                self.assertIn('mine.yaml', str(caught.exception))


class Analysis(Folder):
    """Three people whose ratings follow the KES values, once upwards, once downwards for real ones."""

    def setUp(self):
        super().setUp()
        protocol = read_protocol(CONFIG / 'protocols' / 'eight_properties.yaml', CONFIG)
        real = tuple(Sample(sample.fabric, REAL) for sample in protocol.samples)
        self.protocol = protocol._replace(samples=protocol.samples + real)
        self.values = {sample.fabric: values_of(sample.fabric) for sample in protocol.samples}

    def write(self, who, subject, rate, keep=lambda trial: True):
        """@param rate share of the fabric among all, from 0 to 1, and kind -> rating"""
        path = self.folder / f'{who}.csv'
        file = ResultFile(path, self.protocol.scale, self.fail)
        self.addCleanup(file.close)
        for trial in filter(keep, trials_of(self.protocol, subject)):
            value = self.values[trial.sample.fabric].properties[trial.property.name]
            below = sum(other.properties[trial.property.name] < value for other in self.values.values())
            file.add(Result(who, subject, trial.number, trial.property.name, trial.sample.kind,
                            trial.sample.fabric, trial.code, trial.position,
                            rate(below / 5, trial.sample.kind), 1.0, 2.0, True, ''))
        return path

    def run_analysis(self, *paths):
        out = self.folder / 'out'
        self.assertEqual(analysis.main([*map(str, paths), str(out)]), 0)
        return out

    def rows(self, path):
        with open(path, encoding='utf-8', newline='') as file:
            return list(csv.DictReader(file))

    def test_finds_the_order_that_was_put_in(self):
        def rate(share, kind):
            return 1 + 4 * share if kind == VIRTUAL else 10 - 4 * share
        out = self.run_analysis(*(self.write(f'P{i}', i, rate) for i in (1, 2, 3)))
        for row in self.rows(out / 'correlations.csv'):
            expected = {'KES - virtual': 1, 'KES - real': -1, 'real - virtual': -1}[row['between']]
            self.assertEqual(float(row['Spearman rho']), expected, row)
            self.assertEqual(float(row['Kendall tau-b']), expected, row)
            self.assertEqual(row['pairs'], '6')
        for row in self.rows(out / 'agreement.csv'):
            self.assertEqual((row['raters'], row['samples'], float(row['Kendall W'])), ('3', '12', 1.0))
        ranks = self.rows(out / 'ranks.csv')
        self.assertEqual(len(ranks), 8 * 12)
        for row in ranks:  # ranked together: all real ones above all virtual ones
            self.assertEqual(float(row['mean rank']) > 6, row['sample'] == 'real')
        for name in PROPERTIES:
            self.assertEqual((out / f'{name}.png').read_bytes()[:4], b'\x89PNG')
        self.assertNotIn('## Missing', (out / 'evaluation.md').read_text())

    def test_says_what_is_missing(self):
        whole = self.write('P1', 1, lambda share, _: 1 + share)
        part = self.write('P2', 2, lambda share, _: 1 + share, lambda trial: trial.number < 5)
        text = (self.run_analysis(whole, part) / 'evaluation.md').read_text()
        self.assertIn('P2 did not rate all samples', text)
        self.assertIn('agreement takes two raters', text)

    def test_says_of_which_fabrics_there_is_no_kes_value(self):
        def result(fabric, rating):
            return Result('P1', 1, 1, 'roughness', VIRTUAL, fabric, '100', 1, rating, 1.0, 2.0, True, '')
        values = {name: values_of(name) for name in ('wool', 'linear')}
        group = analysis.make_group('roughness', True, [result('wool', 1.0), result('linear', 2.0)],
                                    values)
        self.assertEqual(group.kes, [None, values['wool'].properties['roughness']])
        self.assertIsNone(group.correlations[0].rho)
        self.assertIn('roughness: the files of linear have no value for it.',
                      analysis.remarks([group]))

    def test_ratings_with_and_without_the_picture_are_apart(self):
        shown = self.write('P1', 1, lambda share, _: 1 + share)
        hidden = self.folder / 'hidden.csv'
        hidden.write_text(shown.read_text().replace(',true,', ',false,'))
        out = self.run_analysis(shown, hidden)
        self.assertEqual([row['picture'] for row in self.rows(out / 'agreement.csv')],
                         ['shown', 'hidden'] * 8)
        self.assertTrue((out / 'drape_hidden.png').exists())

    def test_refuses_files_that_do_not_belong_together(self):
        path = self.write('P1', 1, lambda share, _: 1 + share)
        with self.assertRaisesRegex(ValueError, 'is there twice'):
            analysis.read_all([path, path])
        other = self.folder / 'other.csv'
        other.write_text(path.read_text().replace('1 to 10', '0 to 100'))
        with self.assertRaisesRegex(ValueError, 'all must have the same scale'):
            analysis.read_all([path, other])
        with self.assertRaisesRegex(ValueError, 'the columns are none'):
            (self.folder / 'empty.csv').write_text('')
            analysis.read_all([self.folder / 'empty.csv'])


Tests = suite_of(KesValues, HandValues, Analysis)


if __name__ == '__main__':
    rostest.rosrun('haptex', 'evaluation_analysis', f'{__name__}.Tests')
