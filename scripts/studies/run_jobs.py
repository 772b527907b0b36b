#!/usr/bin/python3
"""Runs the jobs of a study and merges them: scripts/study says what its arguments are, behind the program run_study and
the directory below which results lie."""
import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

JOBS = 64  # many more than processors, so that all end at about the same time
MOST_JOBS = 100000
POLL = 0.5  # s, between two looks at Slurm's queue


def number(text):
    """@throws argparse.ArgumentTypeError"""
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= MOST_JOBS:
        raise argparse.ArgumentTypeError(f'{text[:200]!r}: allowed are 1 to {MOST_JOBS}')
    return int(text)


def arguments_of(argv):
    parser = argparse.ArgumentParser(prog='scripts/study', allow_abbrev=False)
    parser.add_argument('program', help=argparse.SUPPRESS)
    parser.add_argument('results', help=argparse.SUPPRESS)
    parser.add_argument('study', choices=('extremes', 'self_colliding', 'garments', 'trade_off', 'evaluation'))
    parser.add_argument('--cases', help='how many')
    parser.add_argument('--seed', help='of the first')
    parser.add_argument('--jobs', type=number, help=f'into which it is split ({JOBS}, or one for each unit)')
    parser.add_argument('--directory', help='of the jobs and the result (build/studies/STUDY)')
    parser.add_argument('--workers', type=number, help='jobs at the same time, on each machine (its processors)')
    where = parser.add_mutually_exclusive_group()
    where.add_argument('--sshloginfile', help="machines, as GNU parallel's option of that name has them")
    where.add_argument('--slurm', action='store_true', help='as an array of Slurm')
    return parser.parse_args(argv)


def study_of(arguments):
    """The command that tells what the study has to compute."""
    command = [arguments.program, arguments.study]
    for option in ('cases', 'seed'):
        value = getattr(arguments, option)
        if value is not None:
            command += [f'--{option}', value]
    return command


def jobs_of(study):
    """How many where nobody says it: no more than units. Ends as the program does if that refuses the study."""
    told = subprocess.run(study, stdout=subprocess.PIPE, text=True)
    if told.returncode != 0:
        sys.exit(told.returncode)
    return min(JOBS, int(dict(line.split('\t') for line in told.stdout.splitlines())['units']))


def needed(program, package):
    if not shutil.which(program):
        raise RuntimeError(f'{program} is missing: apt install {package}')


def by_parallel(arguments, directory, command):
    """GNU parallel goes on when a job fails; the merge tells what is missing then."""
    needed('parallel', 'parallel')
    options = ['--joblog', str(directory / 'jobs.log')]
    if arguments.workers:
        options += ['--jobs', str(arguments.workers)]
    before = ''
    if arguments.sshloginfile:
        # Each machine computes into a directory of the same name, and its files are fetched.
        result = directory / f'{arguments.study}_{{}}_of_{arguments.jobs}.txt'
        options += ['--sshloginfile', arguments.sshloginfile, '--return', str(result)]
        before = f'mkdir -p {shlex.quote(str(directory))} && '
    indices = '\n'.join(map(str, range(1, arguments.jobs + 1)))
    # Without a named shell GNU parallel takes SHELL, and where that is not set its own parent, which is Python.
    subprocess.run(['parallel', *options, before + shlex.join(command) + ' --job {}'], input=indices, text=True,
                   env={**os.environ, 'PARALLEL_SHELL': '/bin/sh'})


def by_slurm(arguments, directory, command):
    needed('sbatch', 'slurm-client')
    array = f'1-{arguments.jobs}' + (f'%{arguments.workers}' if arguments.workers else '')
    answer = subprocess.run(['sbatch', '--parsable', f'--job-name={arguments.study}', f'--array={array}',
                             f'--output={directory}/job_%a.log',
                             f'--wrap=exec {shlex.join(command)} --job $SLURM_ARRAY_TASK_ID'],
                            stdout=subprocess.PIPE, text=True)
    if answer.returncode != 0:
        raise RuntimeError(f'sbatch ended with {answer.returncode}')
    job = answer.stdout.strip().split(';')[0]
    print(f"Slurm's job {job}", file=sys.stderr)
    try:
        # The queue forgets a job some minutes after its end.
        while subprocess.run(['squeue', '--noheader', f'--jobs={job}'], stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL, text=True).stdout.strip():
            time.sleep(POLL)
    except KeyboardInterrupt:
        subprocess.run(['scancel', job], check=False)
        raise


def main(argv):
    arguments = arguments_of(argv)
    study = study_of(arguments)
    arguments.jobs = arguments.jobs or jobs_of(study)
    directory = pathlib.Path(arguments.directory or pathlib.Path(arguments.results) / arguments.study).resolve()
    directory.mkdir(parents=True, exist_ok=True)
    command = [*study, '--directory', str(directory), '--jobs', str(arguments.jobs)]
    try:
        (by_slurm if arguments.slurm else by_parallel)(arguments, directory, command)
    except RuntimeError as error:
        print(f'study: {error}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print('study: interrupted; what is computed stays, the same command goes on', file=sys.stderr)
        return 130
    return subprocess.run([*command, '--merge', str(directory / f'{arguments.study}.txt')]).returncode


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
