#!/usr/bin/python3
"""The evaluation by machine in units, as run_study asks for it (include/haptex/studies/jobs/script_study.h): a unit is a
fabric with a seed of the tremor, fabrics in turn. Its record has, with tabs between, fabric and seed, then of everything
that was judged name, value and standard deviation; "coarse/NAME" by the coarse device."""
import argparse
import hashlib
import pathlib
import platform
import re
import sys
import tempfile

import numpy
import scipy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from machine_rater import rater, study  # noqa: E402

COARSE = 'coarse/'


def checksum(paths):
    """Of names and bytes."""
    total = hashlib.sha256()
    for path in sorted(paths):
        total.update(f'{path.name}\0'.encode() + path.read_bytes())
    return total.hexdigest()[:16]


def libraries():
    """By which sums are rounded. Debian has several for linear algebra."""
    mapped = pathlib.Path('/proc/self/maps').read_text(encoding='utf-8')
    blas = sorted(set(re.findall(r'/(lib\w*blas[^/\n]*)$', mapped, re.MULTILINE)))
    return ' '.join([f'Python {platform.python_version()} numpy {numpy.__version__} scipy {scipy.__version__}', *blas])


def processor():
    """As the kernel calls it: those libraries choose by it how they compute."""
    found = re.search(r'^model name\s*: (.*)', pathlib.Path('/proc/cpuinfo').read_text(encoding='utf-8'), re.MULTILINE)
    return found[1] if found else platform.machine()


def describe(arguments):
    if not study.PROGRAM.exists():
        raise SystemExit(f'{study.PROGRAM} is missing: scripts/study builds it')
    fabrics = study.fabric_names()
    evaluation = ROOT / 'src' / 'nodes' / 'evaluation' / 'haptex_evaluation'
    print(f'units\t{arguments.cases * len(fabrics)}\ncases\t{arguments.cases}\nseed\t{arguments.seed}')
    print(f'fabrics\t{checksum((ROOT / "config" / "fabrics").glob("*.yaml"))}')
    print(f'rater\t{checksum([*pathlib.Path(__file__).parent.glob("*.py"), *evaluation.glob("*.py"), study.PROGRAM])}')
    print(f'libraries\t{libraries()}\nprocessor\t{processor()}')


def run(arguments):
    fabrics = study.fabric_names()
    round_, place = divmod(arguments.unit, len(fabrics))
    fabric, seed = fabrics[place], arguments.seed + round_
    with tempfile.TemporaryDirectory() as directory:
        hand, (strokes,) = study.run_hand(directory, [fabric], [(seed, study.FINEST)])
        judged, coarse = (study.judge_record(directory, hand, fabric, strokes.get(fabric), seed, study.FINEST, limits)
                          for limits in (None, study.LIMITS))
    print(record_of(fabric, seed, judged, coarse))


def record_of(fabric, seed, judged, coarse):
    """Floats as Python prints them are read back as the same ones."""
    fields = [fabric, str(seed)]
    for before, judgements in (('', judged), (COARSE, coarse)):
        for name, (value, uncertainty) in judgements.items():
            fields += [before + name, repr(float(value)), repr(float(uncertainty))]
    return '\t'.join(fields)


def parse(record):
    """Fabric, seed, judgements, and those by the coarse device."""
    fields = record.split('\t')
    try:
        fabric, seed = fields[:2]
        judged, coarse = {}, {}
        for name, value, uncertainty in zip(fields[2::3], fields[3::3], fields[4::3], strict=True):
            of_device = coarse if name.startswith(COARSE) else judged
            of_device[name.removeprefix(COARSE)] = rater.Judgement(float(value), float(uncertainty))
        return fabric, int(seed), judged, coarse
    except ValueError:
        raise SystemExit(f'{record[:200]!r} is no result of an evaluation') from None


def summary(_):
    """What scripts/evaluate prints, of the first seed; repeat is the least of all pairs of seeds."""
    runs, by_coarse_device = {}, {}
    for record in sys.stdin:
        fabric, seed, judged, coarse = parse(record.rstrip('\n'))
        runs.setdefault(seed, {})[fabric] = judged
        by_coarse_device.setdefault(fabric, coarse)
    fabrics = list(by_coarse_device)
    files = {fabric: study.values_of(fabric) for fabric in fabrics}
    first, *_ = runs.values()
    study.print_judgements(fabrics, first, files)
    study.print_ranks(fabrics, list(runs.values()), by_coarse_device, files)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('cases', type=int, help='seeds for each fabric')
    parser.add_argument('seed', type=int, help='the first')
    tasks = parser.add_subparsers(required=True)
    tasks.add_parser('describe').set_defaults(do=describe)
    one = tasks.add_parser('run')
    one.add_argument('unit', type=int)
    one.set_defaults(do=run)
    tasks.add_parser('summary').set_defaults(do=summary)
    arguments = parser.parse_args()
    arguments.do(arguments)


if __name__ == '__main__':
    main()
