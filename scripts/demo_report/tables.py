"""Tables of a demo, on standard output."""
import numpy as np

from .recording import bar_forces
from .series import FINGERS, PHASES, WITH_CONTACT, Series


def print_phases(recording):
    """What the last second of every phase was like, and the largest forces of the whole phase."""
    print(f"{'':9}{'':>6}{'felt, N':>14}{'rendered, N':>16}{'pinch':>9}{'pull':>7}{'bar':>9}"
          f"{'area, mm2':>13}{'slid, mm':>15}{'largest, N':>22}")
    print(f"{'phase':9}{'s':>6}{'index':>8}{'thumb':>7}{'index':>8}{'thumb':>7}"
          f"{'N':>9}{'N':>7}{'N':>9}{'index':>7}{'thumb':>7}{'index':>7}{'thumb':>7}"
          f"{'index':>9}{'thumb':>7}{'bar':>11}")
    bar = Series()
    bar.times, bar.values = recording.states.times, bar_forces(recording)
    for phase in PHASES:
        begin, end = recording.span(phase)
        last = recording.last_second(phase)
        felt = {f: recording.felt[f].between(*last) for f in FINGERS}
        contact = {f: recording.contact[f].between(*last) for f in FINGERS}
        # What the fingers press against each other, and what is left of it, pulls the cloth.
        means = [felt[f].mean(axis=0) for f in FINGERS]
        row = f'{phase:9}{end - begin:6.1f}'
        row += ''.join(f'{np.linalg.norm(felt[f], axis=1).mean():{w}.3f}'
                       for f, w in zip(FINGERS, [8, 7]))
        row += ''.join(f'{contact[f][:, 0].mean():{w}.3f}' for f, w in zip(FINGERS, [8, 7]))
        row += f'{np.linalg.norm(means[0] - means[1]) / 2:9.3f}'
        row += f'{np.linalg.norm(means[0] + means[1]):7.3f}{bar.between(*last).mean():9.4f}'
        row += ''.join(f'{1e6 * contact[f][:, 2].mean():7.0f}' for f in FINGERS)
        row += ''.join(f'{1e3 * slid(recording.contact[f], begin, end):7.1f}' for f in FINGERS)
        whole = {f: recording.felt[f].between(begin, end) for f in FINGERS}
        row += ''.join(f'{np.linalg.norm(whole[f], axis=1).max():{w}.3f}'
                       for f, w in zip(FINGERS, [9, 7]))
        row += f' {bar.between(begin, end).max():10.4g}'
        print(row)


def print_holds(recording, judgement):
    """What was felt while the fingers held: its median, and how often it dipped."""
    print(f"{'':9}{'':7}{'median, N':>15}{'dips':>14}{'longest, ms':>15}")
    print(f"{'hold':9}{'':7}" + f"{'index':>8}{'thumb':>7}" * 3)
    for phase, held in judgement.held.items():
        lengths = [[1e3 * dip.length for dip in judgement.dips
                    if (dip.phase, dip.finger) == (phase, finger)] for finger in FINGERS]
        row = f"{phase:9}{'held' if held else 'LOST':>7}"
        row += ''.join(f'{judgement.medians.get((phase, finger), np.nan):{width}.3f}'
                       for finger, width in zip(FINGERS, [8, 7]))
        row += ''.join(f'{len(of_finger):{width}}' for of_finger, width in zip(lengths, [8, 7]))
        row += ''.join(f'{max(of_finger, default=0.0):{width}.1f}'
                       for of_finger, width in zip(lengths, [8, 7]))
        print(row)


def print_tactile(recording):
    """Vibration of the contactors in the phases with contact: mean over all of them and the phase,
    and the largest of any."""
    print(f"{'':9}{'index, um':>32}{'':4}{'thumb, um':>32}")
    print(f"{'':9}" + f"{'40 Hz':>10}{'':6}{'320 Hz':>10}{'':6}{'speed':>4}" * 2)
    print(f"{'phase':9}" + f"{'mean':>8}{'largest':>8}{'mean':>8}{'largest':>8}{'mm/s':>6}" * 2)
    for phase in WITH_CONTACT:
        row = f'{phase:9}'
        for finger in FINGERS:
            steps = recording.tactile_of(finger, phase)
            amplitudes = np.array([amplitude for amplitude, _ in steps])
            for channel in range(2):
                of_channel = amplitudes[:, :, channel]
                row += f'{of_channel.mean():8.2f}{of_channel.max():8.2f}'
            row += f'{1e3 * np.mean([speed for _, speed in steps]):6.1f}'
        print(row)


def slid(contact, begin, end):
    """How far a fingertip has slipped over the cloth, m."""
    within = contact.within(begin, end)
    speeds = np.array(contact.values[within])[:, 3]
    return np.sum(speeds[1:] * np.diff(contact.times[within]))


def qualities(recording):
    """Those by which the cloth was computed, and for which share of the demo."""
    names = recording.qualities.values
    if not names:
        return 'as the scene says'
    lengths = {}
    for name, length in zip(names, np.diff(recording.qualities.times)):
        lengths[name] = lengths.get(name, 0.0) + length
    total = sum(lengths.values())
    return '; '.join(f'{name} for {100 * length / total:.1f} %' for name, length in lengths.items())


def print_rates(recording):
    states = recording.states
    steps = np.array([state[0] for state in states.values], dtype=float)
    simulated, elapsed = recording.real_time()
    cloth, sources = (recording.diagnostics[n] for n in ['cloth simulation', 'force sources'])
    print(f"{cloth['triangles']} triangles, fabric {', '.join(recording.mesh.fabrics)}, steps of "
          f"{float(cloth['time step (ms)']):g} ms")
    for finger in FINGERS:
        gaps = 1e3 * np.diff(recording.contact[finger].times)
        print(f'force loop, {finger}    {recording.contact[finger].rate():.1f} Hz, between two '
              f'forces {np.percentile(gaps, 50):.2f} ms (median), {np.percentile(gaps, 99):.2f} '
              f'ms (p99), {gaps.max():.1f} ms (largest)')
    print(f'cloth                {(steps[-1] - steps[0]) / elapsed:.2f} Hz, real-time factor '
          f'{simulated / elapsed:.4f}  ({simulated:.3f} s simulated in {elapsed:.3f} s)')
    print(f'quality              {qualities(recording)}')
    print(f"queries              {int(sources['queries answered']) / elapsed:.1f} Hz, "
          f"{sources['queries failed']} failed")
    print(f"dropped              {float(cloth['dropped simulated time (s)']):g} s of cloth, "
          f"{sources['states dropped']} states by the force renderer, "
          f'{int(np.sum(np.diff(steps)) - len(steps) + 1)} states not recorded')


def print_host(recording):
    """What the machine took away."""
    host = recording.diagnostics['host']
    print(f"host                 {host['steal (s)']} s stolen "
          f"({100 * float(host['steal (share)']):.2f} % of the processors), {host['stalls']} stalls")
    if int(host['stalls']):
        begin = float(host['longest stall began (s since the epoch)'])
        print(f"{'':21}the longest {host['longest stall (ms)']} ms, "
              f'{begin - recording.begins[PHASES[0]]:.2f} s after the start, with '
              f"{host['steal around the longest stall (ms)']} ms of steal; SCHED_FIFO "
              f"{host['SCHED_FIFO']}")
