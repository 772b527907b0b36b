"""Judges fabrics by machine: the manipulations in simulated time, estimates, and rank correlations with
what the fabric files say. Called by scripts/evaluate."""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'scripts'), str(ROOT / 'src' / 'nodes' / 'evaluation')]
from haptex_evaluation import statistics  # noqa: E402
from haptex_evaluation.kes_values import FabricValues  # noqa: E402
from machine_rater import rater  # noqa: E402
from machine_rater.records import DeviceRecord  # noqa: E402

PROGRAM = ROOT / 'build' / 'devel' / 'lib' / 'haptex' / 'device_records'
SEEDS = (1, 2)  # of the tremor
RATE = 80.0  # Hz, of the large-scale cloth
LIMITS = {'quantum': 0.005, 'delay': 0.003}  # N, s: of a device with a coarse sensor and a slow loop
NOT_FABRICS = ('linear',)  # neither woven nor knitted
DOWN, SIDEWAYS = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
# Unit, and by what a value of the file is of the same quantity: then its error is told.
PROPERTIES = {'tensile_stiffness': ('N/m', True), 'shear_stiffness': ('N/m', False),
              'roughness': ('um', False), 'friction': ('1', True), 'compressibility': ('1', True),
              'thickness_under_load': ('m', True), 'weight': ('kg/m2', True)}
# By strokes that do not tremble and meet no limit of the device: to repeat them says nothing.
BY_STROKES = ('roughness',)
NOT_JUDGED = ('bending_stiffness', 'drape')


def say(text):
    print(f'evaluate: {text}', file=sys.stderr, flush=True)


def fabric_names():
    return [path.stem for path in sorted((ROOT / 'config' / 'fabrics').glob('*.yaml'))
            if path.stem not in NOT_FABRICS]


def run_hand(directory, fabrics):
    """Both seeds at once. @returns what the program says: fingertips, and strokes by fabric"""
    runs = [subprocess.Popen([PROGRAM, ROOT / 'config', directory, str(seed), str(RATE), *fabrics],
                             stdout=subprocess.PIPE, text=True) for seed in SEEDS]
    said = []
    for line in runs[0].stdout:
        fields = line.rstrip('\n').split('\t')
        said.append(fields)
        if fields[0] == 'done':
            say(f'{fields[1]} has been touched')
    for run in runs:
        run.communicate()
        if run.returncode != 0:
            raise SystemExit(f'evaluate: {PROGRAM} failed')
    fingertips = next(rater.Fingertips(*map(float, fields[1:])) for fields in said
                      if fields[0] == 'fingertips')
    strokes = {fields[1]: float(fields[2]) for fields in said if fields[0] == 'stroke'}
    return fingertips, strokes


def judge_drawn(read):
    drawn = [rater.stiffness(read(f'draw_{way}'), DOWN, 0.05, 0.3) for way in ('warp', 'weft')]
    return [rater.Judgement(float(np.mean([one.value for one in drawn])),
                            float(np.hypot(*(one.uncertainty for one in drawn)) / 2.0))]


def judge(read, fingertips, stroke, what):
    """Judgements by property; of what a record does not show there is none, and that is said.
    @param read a DeviceRecord by the name of its manipulation
    @param stroke perceived intensity (m) of the contactors, or none without a surface
    @param what for the message"""
    ways = (
        (('weight',), lambda: [rater.weight(read('weigh'))]),
        (('friction',), lambda: [rater.friction(read('drag'))]),
        (('thickness_under_load', 'compressibility'),
         lambda: rater.compression(read('pinch'), fingertips)[1:]),
        (('tensile_stiffness',), lambda: judge_drawn(read)),
        (('shear_stiffness',), lambda: [rater.stiffness(read('shear'), SIDEWAYS, 0.02, 0.15)]))
    found = {}
    for names, way in ways:
        try:
            found.update(zip(names, way()))
        except ValueError as error:
            say(f'{what}, no {" and ".join(names)}: {error}')
    if stroke is not None:
        found['roughness'] = rater.Judgement(1e6 * stroke, 0.0)
    return found


def values_of(fabric):
    """What the file says, in the units of the judgements."""
    values = FabricValues(ROOT / 'config' / 'fabrics' / f'{fabric}.yaml')
    properties = dict(values.properties)
    if 'compressibility' in properties:
        thick = 1e-3 * values.parameters['T']
        properties['thickness_under_load'] = thick * (1.0 - properties['compressibility'])
    if 'roughness' in properties:
        properties['roughness'] *= 1e6
    # Compressibilities that the files mean to be equal differ by rounding.
    return {name: float(f'{value:.9g}') for name, value in properties.items()}


def print_judgements(fabrics, judged, files):
    for fabric in fabrics:
        for name, (unit, _) in PROPERTIES.items():
            if name in judged[fabric]:
                value, uncertainty = judged[fabric][name]
                print(f'judged/{fabric}/{name}\t{value:.5g}\t{uncertainty:.2g}\t{unit}\t'
                      f'{files[fabric].get(name, float("nan")):.5g}')


def print_ranks(fabrics, judged, again, coarse, files):
    """Rank correlations with the files, between two seeds of the tremor, and by a coarse device."""
    for name, (_, same) in PROPERTIES.items():
        known = [fabric for fabric in fabrics if name in judged[fabric] and name in files[fabric]]
        if len(known) < 3:
            say(f'{name}: {len(known)} fabrics, no ranks')
            continue
        def column(of):
            return np.array([of[fabric][name].value for fabric in known])
        file = np.array([files[fabric][name] for fabric in known])
        low, high = statistics.bootstrap_interval(statistics.spearman, column(judged), file)
        print(f'evaluate/{name}/spearman\t{statistics.spearman(column(judged), file):.4f}\t'
              f'{low:.4f}\t{high:.4f}')
        if name in BY_STROKES:
            continue
        print(f'evaluate/{name}/repeat\t{statistics.spearman(column(judged), column(again)):.4f}')
        if all(name in coarse[fabric] for fabric in known):
            print(f'evaluate/{name}/spearman_coarse\t'
                  f'{statistics.spearman(column(coarse), file):.4f}')
        if same:
            print(f'evaluate/{name}/value_error\t{np.abs(column(judged) / file - 1.0).max():.4f}')


def draw_picture(path, fabrics, judged, files):
    """Estimates against the files, a panel per property."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    picture, panels = pyplot.subplots(2, 4, figsize=(13, 6.5), constrained_layout=True)
    for panel, (name, (unit, same)) in zip(panels.flat, PROPERTIES.items()):
        known = [fabric for fabric in fabrics if name in judged[fabric] and name in files[fabric]]
        file = [files[fabric][name] for fabric in known]
        estimates = [judged[fabric][name].value for fabric in known]
        panel.plot(file, estimates, 'o', ms=4, color='#1f6fb4')
        if max(file) > 5.0 * min(file):
            panel.set(xscale='log', yscale='log')
        for fabric, x, y in zip(known, file, estimates):
            panel.annotate(fabric.replace('_', ' '), (x, y), fontsize=6, xytext=(3, 2),
                           textcoords='offset points')
        if same:
            ends = np.array([min(file), max(file)])
            panel.plot(ends, ends, color='#555', lw=0.8)
        panel.set(title=name.replace('_', ' '), xlabel='fabric file', ylabel=f'judged, {unit}')
        panel.margins(x=0.2)
    panels.flat[-1].set_axis_off()
    picture.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(prog='scripts/evaluate', description=__doc__.splitlines()[0])
    parser.add_argument('fabrics', nargs='*', metavar='FABRIC', help='of config/fabrics; none: all')
    parser.add_argument('--picture', help='path of a PNG to draw the judgements into')
    arguments = parser.parse_args()
    fabrics = arguments.fabrics or fabric_names()
    unknown = sorted(set(fabrics) - set(fabric_names()))
    if unknown:
        parser.error(f'no fabric {", ".join(unknown)}; there are {", ".join(fabric_names())}')
    files = {fabric: values_of(fabric) for fabric in fabrics}
    judged, again, coarse = {}, {}, {}
    with tempfile.TemporaryDirectory() as directory:
        fingertips, strokes = run_hand(directory, fabrics)
        for fabric in fabrics:
            def read(name, seed=SEEDS[0], fabric=fabric):
                return DeviceRecord.read(f'{directory}/{fabric}_{name}_{seed}.f32')
            stroke = strokes.get(fabric)
            judged[fabric] = judge(read, fingertips, stroke, fabric)
            again[fabric] = judge(lambda name: read(name, SEEDS[1]), fingertips, stroke, fabric)
            coarse[fabric] = judge(lambda name: read(name).limited(**LIMITS), fingertips, stroke,
                                   f'{fabric} by a coarse device')
    if arguments.picture:
        draw_picture(arguments.picture, fabrics, judged, files)
    print_judgements(fabrics, judged, files)
    print_ranks(fabrics, judged, again, coarse, files)
    say('not judged: ' + ', '.join(NOT_JUDGED))


if __name__ == '__main__':
    main()
