"""Judges fabrics by machine: the manipulations in simulated time, estimates, and rank correlations with
what the fabric files say. Called by scripts/evaluate."""
import argparse
import concurrent.futures
import itertools
import pathlib
import subprocess
import sys
import tempfile
from typing import NamedTuple

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'scripts'), str(ROOT / 'src' / 'nodes' / 'evaluation')]
from haptex_evaluation import statistics  # noqa: E402
from haptex_evaluation.kes_values import FabricValues  # noqa: E402
from machine_rater import overhang, pressed_strips, rater  # noqa: E402
from machine_rater.records import DeviceRecord  # noqa: E402

PROGRAM = ROOT / 'build' / 'devel' / 'lib' / 'haptex' / 'device_records'
SEEDS = (1, 2)  # of the tremor
FINEST = 'finest'  # how the cloth is computed unless by a preset
PRESETS = ('fast', 'balanced', 'accurate')
LIMITS = {'quantum': 0.005, 'delay': 0.003}  # N, s: of a device with a coarse sensor and a slow loop
PROCESSES = 2
NOT_FABRICS = ('linear',)  # neither woven nor knitted
# Unit, and by what a value of the file is of the same quantity: then its error is told.
PROPERTIES = {'tensile_stiffness': ('N/m', True), 'shear_stiffness': ('N/m', True),
              'bending_stiffness': ('N.m', True), 'roughness': ('um', False),
              'friction': ('1', True), 'compressibility': ('1', True),
              'thickness_under_load': ('m', True), 'weight': ('kg/m2', True), 'drape': ('m', True)}
# By strokes without cloth, which meet no limit of the device.
BY_STROKES = ('roughness',)


class Hand(NamedTuple):
    """What a hand knows of itself and of the strips that it cut."""
    fingertips: rater.Fingertips
    pinch_seconds: float
    pressed: pressed_strips.Contact
    biased: pressed_strips.Contact
    overhang: pressed_strips.Strip


def say(text):
    print(f'evaluate: {text}', file=sys.stderr, flush=True)


def fabric_names():
    return [path.stem for path in sorted((ROOT / 'config' / 'fabrics').glob('*.yaml'))
            if path.stem not in NOT_FABRICS]


def run_hand(directory, fabrics, runs):
    """At most PROCESSES at once. @param runs pairs of the tremor's seed and of how the cloth is computed
    @returns what the program says: the hand, and strokes by fabric for each run"""
    def run(pair):
        seed, quality = pair
        folder = pathlib.Path(directory) / quality
        folder.mkdir(exist_ok=True)
        process = subprocess.Popen(
            [PROGRAM, ROOT / 'config', folder, str(seed), quality, *fabrics],
            stdout=subprocess.PIPE, text=True)
        said = []
        for line in process.stdout:
            said.append(line.rstrip('\n').split('\t'))
            if said[-1][0] == 'done':
                say(f'{said[-1][1]} has been touched ({quality}, tremor {seed})')
        if process.wait() != 0:
            raise SystemExit(f'evaluate: {PROGRAM} failed')
        return said
    with concurrent.futures.ThreadPoolExecutor(PROCESSES) as pool:
        said = list(pool.map(run, runs))
    numbers = {tuple(fields[:2]) if fields[0] == 'strip' else fields[0]: fields for fields in said[0]}
    fingertips = rater.Fingertips(*map(float, numbers['fingertips'][1:]))
    pressed, biased, over = (pressed_strips.Strip(*map(float, numbers['strip', name][2:]))
                             for name in ('pressed', 'biased', 'overhang'))
    def contact(strip):
        return pressed_strips.Contact(strip, fingertips.index_radius, fingertips.pulp_stiffness)
    hand = Hand(fingertips, float(numbers['pinch'][1]), contact(pressed), contact(biased), over)
    return hand, [{fields[1]: float(fields[2]) for fields in of_run if fields[0] == 'stroke'}
                  for of_run in said]


def mean(judgements):
    return rater.Judgement(float(np.mean([one.value for one in judgements])),
                           float(np.hypot(*(one.uncertainty for one in judgements)) / 2.0))


def judge(read, hand, stroke, what):
    """Judgements by property; of what a record does not show there is none, and that is said.
    @param read a DeviceRecord by the name of its manipulation
    @param stroke perceived intensity (m) of the contactors, or none without a surface
    @param what for the message"""
    found = {} if stroke is None else {'roughness': rater.Judgement(1e6 * stroke, 0.0)}
    radius = hand.fingertips.index_radius

    def pressed(name, way, *more):
        return way(read(name), hand.biased if name == 'press_bias' else hand.pressed, radius,
                   thickness, *more)

    def attempt(names, way):
        try:
            judgements = way()
        except ValueError as error:
            say(f'{what}, no {" and ".join(names)}: {error}')
            return None
        found.update(zip(names, judgements))
        return judgements

    attempt(('weight',), lambda: [rater.weight(read('weigh'))])
    attempt(('friction',), lambda: [rater.friction(read('drag'))])
    compression = attempt(('thickness', 'thickness_under_load', 'compressibility'), lambda:
                          rater.compression(read('pinch'), hand.fingertips, hand.pinch_seconds))
    # Who cannot tell the thickness takes the strips for thin.
    thickness = found.pop('thickness').value if compression else 0.0
    names = ('press_warp', 'press_weft')
    attempt(('tensile_stiffness',), lambda: [mean(
        [pressed(name, pressed_strips.tensile_stiffness) for name in names])])
    attempt(('shear_stiffness',), lambda: [pressed(
        'press_bias', pressed_strips.shear_stiffness,
        sum(pressed(name, pressed_strips.thread_compliance) for name in names))])
    if 'weight' in found:
        weight = found['weight'].value
        attempt(('bending_stiffness', 'drape'), lambda: hanging(
            [overhang.bending(read(name), hand.overhang, hand.fingertips, thickness, weight)
             for name in ('lower_warp', 'lower_weft')], weight))
    return found


def hanging(rigidities, weight):
    """Mean rigidity and bending length."""
    rigidity = mean(rigidities)
    length = (rigidity.value / (weight * rater.GRAVITY)) ** (1.0 / 3.0)
    return rigidity, rater.Judgement(length, length * rigidity.uncertainty / rigidity.value / 3.0)


def judge_record(directory, hand, fabric, stroke, seed, quality, limits):
    def read(name):
        record = DeviceRecord.read(f'{directory}/{quality}/{fabric}_{name}_{seed}.f32')
        return record.limited(**limits) if limits else record
    return judge(read, hand, stroke, f'{fabric} ({"coarse device" if limits else quality})')


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


def spearman_of(name, fabrics, judged, files):
    """With the files, over the fabrics with both; NaN for less than three, or if one is not judged that
    could be."""
    known = [fabric for fabric in fabrics if name in files[fabric]]
    if len(known) < 3 or any(name not in judged[fabric] for fabric in known):
        return float('nan')
    return statistics.spearman(np.array([judged[fabric][name].value for fabric in known]),
                               np.array([files[fabric][name] for fabric in known]))


def print_ranks(fabrics, runs, coarse, files):
    """Rank correlations with the files, between seeds of the tremor, the least, and by a coarse device.
    @param runs judgements of one seed after the other; all but `repeat` is of the first"""
    judged = runs[0]
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
        if len(runs) > 1 and all(name in run[fabric] for run in runs for fabric in known):
            repeat = min(statistics.spearman(column(one), column(other))
                         for one, other in itertools.combinations(runs, 2))
            print(f'evaluate/{name}/repeat\t{repeat:.4f}')
        if name not in BY_STROKES:
            rank = spearman_of(name, fabrics, coarse, files)
            print(f'evaluate/{name}/spearman_coarse\t{rank:.4f}')
        if same:
            print(f'evaluate/{name}/value_error\t{np.abs(column(judged) / file - 1.0).max():.4f}')


def print_presets(fabrics, by_preset, files):
    for name, (_, same) in PROPERTIES.items():
        if name in BY_STROKES:
            continue
        for preset, judged in by_preset.items():
            print(f'evaluate/{name}/spearman_{preset}\t{spearman_of(name, fabrics, judged, files):.4f}')
            errors = [abs(judged[fabric][name].value / files[fabric][name] - 1.0)
                      for fabric in fabrics if name in judged[fabric] and name in files[fabric]]
            if same and errors:
                print(f'evaluate/{name}/value_error_{preset}\t{max(errors):.4f}\t'
                      f'{np.median(errors):.4f}')


def draw_picture(path, fabrics, judged, files):
    """Estimates against the files, a panel per property."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    from haptex_evaluation.plots import label_points
    picture, panels = pyplot.subplots(3, 3, figsize=(11, 10), constrained_layout=True)
    points = []
    for panel, (name, (unit, same)) in zip(panels.flat, PROPERTIES.items()):
        known = [fabric for fabric in fabrics if name in judged[fabric] and name in files[fabric]]
        file = [files[fabric][name] for fabric in known]
        estimates = [judged[fabric][name].value for fabric in known]
        panel.plot(file, estimates, 'o', ms=4, color='#1f6fb4')
        if max(file) > 5.0 * min(file):
            panel.set(xscale='log', yscale='log')
        else:
            panel.locator_params(axis='x', nbins=5)
        points.append([(fabric.replace('_', ' '), x, y) for fabric, x, y in zip(known, file, estimates)])
        if same:
            ends = np.array([min(file), max(file)])
            panel.plot(ends, ends, color='#555', lw=0.8)
        panel.set(title=name.replace('_', ' '), xlabel='fabric file', ylabel=f'judged, {unit}')
        panel.margins(x=0.2, y=0.15)
    picture.canvas.draw()  # gives the panels their places
    for panel, named in zip(panels.flat, points):
        label_points(panel, named, 7)
    picture.savefig(path, dpi=110)


def draw_presets(path, fabrics, by_device, files):
    """Rank correlation by property for each way to compute the cloth, and the coarse device."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    names = [name for name in PROPERTIES if name not in BY_STROKES]
    picture, panel = pyplot.subplots(figsize=(9, 4.5), constrained_layout=True)
    width = 0.8 / len(by_device)
    for number, (device, judged) in enumerate(by_device.items()):
        ranks = [spearman_of(name, fabrics, judged, files) for name in names]
        places = np.arange(len(names)) + (number + 0.5) * width - 0.4
        panel.bar(places, np.nan_to_num(ranks), width, label=device)
        for place, rank in zip(places, ranks):
            if not np.isfinite(rank):
                panel.text(place, 0.02, 'not told', rotation=90, fontsize=7, ha='center')
    panel.axhline(0.95, color='#555', lw=0.8, ls=':')
    panel.axhline(0.0, color='#555', lw=0.8)
    panel.set_xticks(range(len(names)), [name.replace('_', '\n') for name in names], fontsize=8)
    panel.set(ylabel='rank correlation with the files', ylim=(min(0.0, panel.get_ylim()[0]), 1.05))
    panel.legend(loc='lower center', bbox_to_anchor=(0.5, 1.0), ncol=len(by_device), fontsize=8)
    picture.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(prog='scripts/evaluate', description=__doc__.splitlines()[0])
    parser.add_argument('fabrics', nargs='*', metavar='FABRIC', help='of config/fabrics; none: all')
    parser.add_argument('--picture', help='path of a PNG to draw the judgements into')
    parser.add_argument('--presets', help='judge with the presets, too; path of a PNG to compare them in')
    arguments = parser.parse_args()
    fabrics = arguments.fabrics or fabric_names()
    unknown = sorted(set(fabrics) - set(fabric_names()))
    if unknown:
        parser.error(f'no fabric {", ".join(unknown)}; there are {", ".join(fabric_names())}')
    files = {fabric: values_of(fabric) for fabric in fabrics}
    runs = [(seed, FINEST) for seed in SEEDS]
    if arguments.presets:
        runs += [(SEEDS[0], preset) for preset in PRESETS]
    with tempfile.TemporaryDirectory() as directory, \
            concurrent.futures.ProcessPoolExecutor(PROCESSES) as pool:
        hand, strokes = run_hand(directory, fabrics, runs)
        def judge_all(run, stroked, limits=None):
            return {fabric: pool.submit(judge_record, directory, hand, fabric, stroked.get(fabric),
                                        *run, limits) for fabric in fabrics}
        def results(futures):
            return {fabric: future.result() for fabric, future in futures.items()}
        waiting = [judge_all(*each) for each in zip(runs, strokes)]
        coarse = results(judge_all(runs[0], strokes[0], LIMITS))
        judged, again, *presets = (results(futures) for futures in waiting)
    if arguments.picture:
        draw_picture(arguments.picture, fabrics, judged, files)
    print_judgements(fabrics, judged, files)
    print_ranks(fabrics, [judged, again], coarse, files)
    if arguments.presets:
        by_preset = dict(zip(PRESETS, presets))
        print_presets(fabrics, by_preset, files)
        draw_presets(arguments.presets, fabrics,
                     {**by_preset, FINEST: judged, 'finest, coarse device': coarse}, files)


if __name__ == '__main__':
    main()
